// @ts-check
import { element } from './data.js';
// The text as it is seen: lines with the colours of their words, and the places of problems underlined. It lies behind
// the text area, whose own letters are clear.

/** @typedef {{start: {line: number, character: number}, end: {line: number, character: number}}} Range */
/** @typedef {{range: Range, severity?: number, message: string, code?: string, codeDescription?: {href: string}}} Problem */
/** @typedef {{from: number, to: number, kind: string}} Part */

/** Words of a line of YAML, by their kinds. */
const WORDS = /(?<comment>(?<=^|\s)#.*)|(?<string>"(?:[^"\\]|\\.)*"|'(?:[^']|'')*')|(?<key>[\w.\-{}]+(?=\s*:(?:\s|$)))|(?<number>(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.]))/g;

/** @param {string} line @returns {Part[]} */
export function words(line) {
  return [...line.matchAll(WORDS)].map((match) => {
    const [kind] = Object.entries(match.groups || {}).find(([, text]) => text !== undefined) || ['plain'];
    return { from: match.index, to: match.index + match[0].length, kind };
  });
}

/** The parts of a problem that are in a line. @param {Problem} problem @param {number} number @param {number} length @returns {Part[]} */
function marked({ range, severity }, number, length) {
  const { start, end } = range;
  if (number < start.line || number > end.line) return [];
  const from = number === start.line ? start.character : 0;
  const to = number === end.line ? end.character : length;
  const kind = severity === 2 ? 'warning' : 'error';
  return [{ from: Math.min(from, Math.max(length - 1, 0)), to: Math.max(to, from + 1), kind }];
}

/** A line in pieces of one look each. @param {string} line @param {Part[]} parts */
function pieces(line, parts) {
  const ends = [...new Set([0, line.length, ...parts.flatMap(({ from, to }) => [from, to])])].filter((at) => at <= line.length).sort((a, b) => a - b);
  return ends.slice(0, -1).map((from, place) => {
    const to = ends[place + 1];
    const kinds = parts.filter((part) => part.from < to && part.to > from).map(({ kind }) => kind);
    return element('span', kinds.length ? { class: kinds.join(' ') } : {}, [line.slice(from, to)]);
  });
}

export class Overlay {
  constructor() {
    this.holder = element('div', { class: 'overlay-text', 'aria-hidden': 'true' });
    /** What each line shows. @type {string[]} */
    this.known = [];
  }

  /** Shows a text; lines that are as they were stay. @param {string} text @param {Problem[]} problems */
  show(text, problems) {
    const lines = text.split('\n');
    lines.forEach((line, number) => {
      const marks = problems.flatMap((problem) => marked(problem, number, line.length));
      const wanted = `${line}\n${marks.map(({ from, to, kind }) => `${from} ${to} ${kind}`).join(';')}`;
      if (this.known[number] === wanted) return;
      const parts = [...words(line), ...marks];
      // A problem behind the end of a line is seen, too.
      const behind = marks.length > 0 && line.length === 0 ? [element('span', { class: marks[0].kind }, [' '])] : [];
      const shown = element('div', { class: 'line' }, [...pieces(line, parts), ...behind]);
      const before = this.holder.children[number];
      if (before) before.replaceWith(shown);
      else this.holder.append(shown);
      this.known[number] = wanted;
    });
    while (this.holder.children.length > lines.length) this.holder.lastElementChild?.remove();
    this.known.length = lines.length;
  }
}
