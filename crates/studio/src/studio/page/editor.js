// @ts-check
import { element } from './data.js';
import { Overlay } from './overlay.js';
// A text area with its overlay: places in it by line and character, as the language server counts them.

/** @typedef {{line: number, character: number}} Position */
/** @typedef {import('./overlay.js').Problem} Problem */

export class Editor {
  /** @param {HTMLElement} holder @param {() => void} changed by the person who types */
  constructor(holder, changed) {
    this.area = /** @type {HTMLTextAreaElement} */ (element('textarea', { spellcheck: 'false', autocapitalize: 'off', autocomplete: 'off', wrap: 'off', 'aria-label': 'Text of the model' }));
    this.overlay = new Overlay();
    this.numbers = element('div', { class: 'numbers', 'aria-hidden': 'true' });
    this.holder = element('div', { class: 'sheet' }, [this.numbers, this.overlay.holder, this.area]);
    holder.append(this.holder);
    /** @type {Problem[]} */
    this.problems = [];
    /** Of a letter, where it was measured. @type {{width: number, height: number} | null} */
    this.size = null;
    this.area.addEventListener('input', () => {
      this.draw();
      changed();
    });
    this.area.addEventListener('scroll', () => this.scrolled());
    this.area.addEventListener('keydown', (event) => this.key(event));
  }

  get text() {
    return this.area.value;
  }

  /** Another document. @param {string} text @param {number} [scroll] @param {number} [caret] */
  show(text, scroll = 0, caret = 0) {
    this.area.value = text;
    this.area.setSelectionRange(caret, caret);
    this.area.scrollTop = scroll;
    this.draw();
  }

  /** @param {Problem[]} problems */
  mark(problems) {
    this.problems = problems;
    this.draw();
  }

  draw() {
    this.overlay.show(this.text, this.problems);
    const count = this.text.split('\n').length;
    while (this.numbers.children.length < count) this.numbers.append(element('div', {}, [String(this.numbers.children.length + 1)]));
    while (this.numbers.children.length > count) this.numbers.lastElementChild?.remove();
    this.scrolled();
  }

  scrolled() {
    const { scrollTop, scrollLeft } = this.area;
    this.overlay.holder.style.transform = `translate(${-scrollLeft}px, ${-scrollTop}px)`;
    this.numbers.style.transform = `translateY(${-scrollTop}px)`;
  }

  /** Two columns at a time; a new line begins where the last did. @param {KeyboardEvent} event */
  key(event) {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const { selectionStart: from, selectionEnd: to } = this.area;
    const start = this.text.lastIndexOf('\n', from - 1) + 1;
    if (event.key === 'Tab' && !event.shiftKey && from === to) {
      event.preventDefault();
      this.replace(from, to, ' '.repeat(2 - ((from - start) % 2)));
    } else if (event.key === 'Enter') {
      event.preventDefault();
      const line = this.text.slice(start, from);
      const [indent] = line.match(/^ */) || [''];
      this.replace(from, to, `\n${indent}${/:\s*$/.test(line) ? '  ' : ''}`);
    }
  }

  /** Replaces a part, as typing does: it can be undone. @param {number} from @param {number} to @param {string} text */
  replace(from, to, text) {
    this.area.focus();
    this.area.setSelectionRange(from, to);
    const typed = text === '' ? document.execCommand('delete') : document.execCommand('insertText', false, text);
    if (typed) return;
    this.area.setRangeText(text, from, to, 'end');
    this.area.dispatchEvent(new Event('input'));
  }

  /** Makes changes of the language server, the last first. @param {{range: {start: Position, end: Position}, newText: string}[]} edits */
  edit(edits) {
    const places = edits.map(({ range, newText }) => ({ from: this.offset(range.start), to: this.offset(range.end), newText }));
    places.sort((a, b) => b.from - a.from).forEach(({ from, to, newText }) => from <= to && this.replace(from, to, newText));
  }

  /** @param {number} offset @returns {Position} */
  position(offset) {
    const before = this.text.slice(0, offset);
    const start = before.lastIndexOf('\n') + 1;
    return { line: before.split('\n').length - 1, character: offset - start };
  }

  /** @param {Position} position */
  offset({ line, character }) {
    let start = 0;
    for (let number = 0; number < line; number++) {
      const end = this.text.indexOf('\n', start);
      if (end < 0) return this.text.length;
      start = end + 1;
    }
    const end = this.text.indexOf('\n', start);
    return Math.min(start + character, end < 0 ? this.text.length : end);
  }

  /** Selects a range and brings it into view. @param {{start: Position, end: Position}} range */
  select({ start, end }) {
    this.area.focus();
    this.area.setSelectionRange(this.offset(start), this.offset(end));
    const { height } = this.letter();
    const top = start.line * height;
    if (top < this.area.scrollTop + height || top > this.area.scrollTop + this.area.clientHeight - 3 * height) {
      this.area.scrollTop = Math.max(0, top - this.area.clientHeight / 3);
    }
    this.scrolled();
  }

  /** Size of a letter, px. */
  letter() {
    this.size ||= this.measured();
    return this.size;
  }

  measured() {
    const line = element('div', { class: 'line' }, ['0'.repeat(100)]);
    line.style.cssText = 'position: absolute; visibility: hidden; width: max-content';
    this.overlay.holder.append(line);
    const { width, height } = line.getBoundingClientRect();
    line.remove();
    return { width: width / 100, height };
  }

  /** Where a position is seen, px in the sheet, below its line. @param {Position} position */
  pixel({ line, character }) {
    const { width, height } = this.letter();
    const style = getComputedStyle(this.area);
    return [parseFloat(style.paddingLeft) + this.area.offsetLeft + character * width - this.area.scrollLeft, parseFloat(style.paddingTop) + (line + 1) * height - this.area.scrollTop];
  }

  /** The position under the pointer; null beside the text. @param {MouseEvent} event */
  under(event) {
    const { width, height } = this.letter();
    const style = getComputedStyle(this.area);
    const { left, top } = this.area.getBoundingClientRect();
    const line = Math.floor((event.clientY - top - parseFloat(style.paddingTop) + this.area.scrollTop) / height);
    const character = Math.floor((event.clientX - left - parseFloat(style.paddingLeft) + this.area.scrollLeft) / width);
    const text = this.text.split('\n')[line];
    return text === undefined || line < 0 || character < 0 || character >= text.length ? null : { line, character };
  }
}
