// @ts-check
import { element } from './data.js';
import { language } from './server.js';
// Help while writing, by the language server: completion, what is under the pointer, and where a name is defined.

/** @typedef {import('./editor.js').Editor} Editor */
/** @typedef {{label: string, detail?: string, insertText?: string, filterText?: string, sortText?: string, documentation?: string | {value: string}, textEdit?: {range: any, newText: string}}} Item */
/** @typedef {{uri: string, range: any}} Place */

/** How long the pointer rests before it is answered, ms. */
const REST = 350;

/** Proposals that are shown. */
const MOST = 60;

export class Assist {
  /** @param {Editor} editor @param {() => string} uri of the document @param {() => Promise<void>} sent when the server has the text @param {(place: Place) => void} go */
  constructor(editor, uri, sent, go) {
    this.editor = editor;
    this.uri = uri;
    this.sent = sent;
    this.go = go;
    this.list = element('ul', { class: 'proposals', role: 'listbox', hidden: '' });
    this.tip = element('div', { class: 'hint', hidden: '' });
    editor.holder.append(this.list, this.tip);
    /** @type {Item[]} */
    this.items = [];
    this.chosen = 0;
    this.asked = 0;
    /** @type {ReturnType<typeof setTimeout> | undefined} */
    this.resting = undefined;
    const { area } = editor;
    area.addEventListener('keydown', (event) => this.key(event), { capture: true });
    area.addEventListener('input', (event) => this.typed(/** @type {InputEvent} */ (event)));
    area.addEventListener('blur', () => this.close());
    area.addEventListener('mousemove', (event) => this.rest(event));
    area.addEventListener('mouseleave', () => this.rest(null));
    area.addEventListener('scroll', () => (this.tip.hidden = true));
    area.addEventListener('click', (event) => (event.ctrlKey || event.metaKey) && this.define());
  }

  document() {
    return { textDocument: { uri: this.uri() } };
  }

  get position() {
    return this.editor.position(this.editor.area.selectionStart);
  }

  /** The word before the caret, as far as it is typed. */
  get begun() {
    const [word] = this.editor.text.slice(0, this.editor.area.selectionStart).match(/[\w]*$/) || [''];
    return word;
  }

  /** @param {InputEvent} event */
  typed(event) {
    this.tip.hidden = true;
    // A key, not a change that was made at once.
    const isWord = event.inputType === 'insertText' && /^[\w.]$/.test(event.data || '');
    if (isWord || !this.list.hidden) this.complete();
  }

  async complete() {
    const number = ++this.asked;
    await this.sent();
    const answer = await language('completion', { ...this.document(), position: this.position }).catch(() => null);
    if (number !== this.asked) return;
    const begun = this.begun.toLowerCase();
    /** @type {Item[]} */
    const all = answer?.items || [];
    const text = (/** @type {Item} */ item) => (item.filterText || item.label).toLowerCase();
    const fits = all.filter((item) => text(item).includes(begun) && text(item) !== begun);
    const rank = (/** @type {Item} */ item) => `${text(item).startsWith(begun) ? 0 : 1}${item.sortText || item.label}`;
    this.items = fits.sort((a, b) => (rank(a) < rank(b) ? -1 : 1)).slice(0, MOST);
    this.chosen = 0;
    this.show();
  }

  show() {
    this.list.hidden = this.items.length === 0;
    this.list.replaceChildren(...this.items.map((item, place) => {
      const made = element('li', { role: 'option', 'aria-selected': String(place === this.chosen) }, [element('b', {}, [item.label]), ' ', element('small', {}, [item.detail || ''])]);
      // Before the text area loses the keyboard.
      made.addEventListener('mousedown', (event) => {
        event.preventDefault();
        this.chosen = place;
        this.take();
      });
      return made;
    }));
    if (this.list.hidden) return;
    this.put(this.list, this.editor.position(this.editor.area.selectionStart - this.begun.length));
    this.list.children[this.chosen]?.scrollIntoView({ block: 'nearest' });
  }

  /** @param {HTMLElement} box @param {{line: number, character: number}} position */
  put(box, position) {
    const [x, y] = this.editor.pixel(position);
    const { clientWidth, clientHeight } = this.editor.holder;
    box.style.left = `${Math.max(4, Math.min(x, clientWidth - box.offsetWidth - 8))}px`;
    const { height } = this.editor.letter();
    box.style.top = `${y + box.offsetHeight > clientHeight && y > box.offsetHeight ? y - box.offsetHeight - height : y}px`;
  }

  close() {
    this.asked++;
    this.items = [];
    this.show();
  }

  take() {
    const item = this.items[this.chosen];
    this.close();
    if (!item) return;
    if (item.textEdit) this.editor.edit([item.textEdit]);
    else {
      const end = this.editor.area.selectionStart;
      this.editor.replace(end - this.begun.length, end, item.insertText || item.label);
    }
    this.close();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const isOpen = !this.list.hidden;
    const move = (/** @type {number} */ step) => {
      this.chosen = (this.chosen + step + this.items.length) % this.items.length;
      this.show();
    };
    /** @type {Record<string, () => void>} */
    const open = { ArrowDown: () => move(1), ArrowUp: () => move(-1), Enter: () => this.take(), Tab: () => this.take(), Escape: () => this.close() };
    const act = isOpen && !event.ctrlKey && !event.altKey ? open[event.key] : undefined;
    if (act) act();
    else if (event.key === ' ' && event.ctrlKey) this.complete();
    else if (event.key === 'F12') this.define();
    else {
      if (['ArrowLeft', 'ArrowRight', 'Home', 'End'].includes(event.key)) this.close();
      return;
    }
    event.preventDefault();
  }

  /** @param {MouseEvent | null} event */
  rest(event) {
    clearTimeout(this.resting);
    const position = event && this.editor.under(event);
    if (!position) {
      this.tip.hidden = true;
      return;
    }
    this.resting = setTimeout(() => this.hover(position), REST);
  }

  /** @param {{line: number, character: number}} position */
  async hover(position) {
    const isIn = (/** @type {import('./overlay.js').Problem} */ { range: { start, end } }) =>
      (start.line < position.line || (start.line === position.line && start.character <= position.character)) &&
      (end.line > position.line || (end.line === position.line && end.character >= position.character));
    const problems = this.editor.problems.filter(isIn).map(({ message }) => element('p', { class: 'problem' }, [message]));
    const answer = await language('hover', { ...this.document(), position }).catch(() => null);
    const text = answer?.contents?.value;
    this.tip.hidden = !text && problems.length === 0;
    this.tip.replaceChildren(...problems, ...(text ? formatted(text) : []));
    if (!this.tip.hidden) this.put(this.tip, position);
  }

  async define() {
    await this.sent();
    const places = await language('definition', { ...this.document(), position: this.position }).catch(() => null);
    if (places?.length) this.go(places[0]);
  }
}

/** The little of Markdown that the language server writes: paragraphs, code, and words in code or bold. @param {string} text */
function formatted(text) {
  return text.split(/```\w*\n([\s\S]*?)```/).flatMap((part, place) => {
    if (place % 2) return [element('pre', {}, [part.trimEnd()])];
    return part.split(/\n\s*\n/).filter((paragraph) => paragraph.trim()).map((paragraph) =>
      element('p', {}, paragraph.split(/(`[^`]+`|\*\*[^*]+\*\*)/).map((piece) => {
        if (/^`.+`$/.test(piece)) return element('code', {}, [piece.slice(1, -1)]);
        if (/^\*\*.+\*\*$/.test(piece)) return element('b', {}, [piece.slice(2, -2)]);
        return piece;
      })));
  });
}
