// @ts-check
import { element } from './data.js';
import { language } from './server.js';
// The list of what is wrong in the text, with the changes that put it right.

/** @typedef {import('./overlay.js').Problem} Problem */
/** @typedef {{uri: string, name: string, problem: Problem}} Listed */

export class Problems {
  /** @param {HTMLElement} holder @param {(uri: string, range: any) => void} go @param {(uri: string, edits: any[]) => void} edit */
  constructor(holder, go, edit) {
    this.holder = holder;
    this.go = go;
    this.edit = edit;
    this.shown = 0;
  }

  /** @param {Listed[]} problems */
  show(problems) {
    const number = ++this.shown;
    const rows = problems.map((listed) => this.row(listed, number));
    const count = (/** @type {number} */ severity, /** @type {string} */ word) => {
      const found = problems.filter(({ problem }) => (problem.severity || 1) === severity).length;
      return found === 0 ? [] : [`${found} ${word}${found > 1 ? 's' : ''}`];
    };
    const heading = [...count(1, 'error'), ...count(2, 'warning')].join(', ') || 'no problems';
    this.holder.replaceChildren(element('h2', {}, [heading]), ...(rows.length ? [element('ul', {}, rows)] : []));
  }

  /** @param {Listed} listed @param {number} number of the list */
  row({ uri, name, problem }, number) {
    const { range, severity, message, code, codeDescription } = problem;
    const place = `${name}:${range.start.line + 1}:${range.start.character + 1}`;
    const [first, ...help] = message.split('\n');
    const jump = element('button', { type: 'button', class: 'jump' }, [element('code', {}, [place]), ` ${first}`]);
    jump.addEventListener('click', () => this.go(uri, range));
    const page = code && codeDescription ? [element('a', { class: 'code', href: codeDescription.href, target: '_blank', rel: 'noreferrer' }, [code])] : [];
    const row = element('li', { class: severity === 2 ? 'warning' : 'error' }, [jump, ...page, ...help.map((line) => element('small', {}, [line]))]);
    this.fixes(uri, range).then((fixes) => number === this.shown && row.append(...fixes));
    return row;
  }

  /** @param {string} uri @param {any} range */
  async fixes(uri, range) {
    const params = { textDocument: { uri }, range, context: { diagnostics: [] } };
    const actions = (await language('codeAction', params).catch(() => null)) || [];
    return actions.map((/** @type {{title: string, edit?: {changes?: Record<string, any[]>}}} */ action) => {
      const button = element('button', { type: 'button', class: 'fix' }, [action.title]);
      button.addEventListener('click', () => Object.entries(action.edit?.changes || {}).forEach(([file, edits]) => this.edit(file, edits)));
      return button;
    });
  }
}
