// @ts-check
import { element } from './data.js';
// The results of a run: its report in a frame of its own, the summary as a terminal shows it, and the files.

/** @typedef {import('./engine.js').Answer} Answer */

const REPORT = 'report.html';

export class Results {
  /** @param {HTMLElement} holder */
  constructor(holder) {
    this.holder = holder;
    this.clear();
  }

  clear() {
    this.holder.classList.remove('old');
    this.holder.replaceChildren(element('p', { class: 'absent' }, ['Run the model: its report comes here. Nothing leaves this page.']));
  }

  /** The text is another by now. */
  age() {
    this.holder.classList.add('old');
  }

  /** @param {Answer} answer */
  show(answer) {
    this.holder.classList.remove('old');
    const views = { Report: this.report(answer), Summary: this.summary(answer), Files: this.files(answer) };
    const tabs = Object.keys(views).map((name) => {
      const tab = element('button', { type: 'button', role: 'tab' }, [name]);
      tab.addEventListener('click', () => choose(name));
      return tab;
    });
    const choose = (/** @type {string} */ chosen) => {
      for (const [index, [name, view]] of Object.entries(views).entries()) {
        tabs[index].setAttribute('aria-selected', String(name === chosen));
        view.hidden = name !== chosen;
      }
    };
    choose('Report');
    this.holder.replaceChildren(element('div', { class: 'tabs', role: 'tablist' }, tabs), ...Object.values(views));
  }

  /** The report, which can reach neither this page nor anything else. @param {Answer} answer */
  report({ files }) {
    const frame = /** @type {HTMLIFrameElement} */ (element('iframe', { title: 'Report', sandbox: 'allow-scripts', class: 'report' }));
    frame.srcdoc = files[REPORT];
    return frame;
  }

  /** @param {Answer} answer */
  summary({ summary, warnings, error }) {
    const lines = [...(error ? [`error: ${error}`] : []), ...warnings.map((warning) => `warning: ${warning}`)];
    const notes = lines.map((line) => element('p', { class: 'note' }, [line]));
    return element('div', { class: 'summary' }, [...notes, element('pre', {}, [summary || ''])]);
  }

  /** @param {Answer} answer */
  files({ files }) {
    const rows = Object.entries(files).map(([name, text]) => {
      const save = element('a', { href: '#', download: name }, [name]);
      // Made when it is asked for; the page keeps no addresses.
      save.addEventListener('click', (event) => {
        event.preventDefault();
        const address = URL.createObjectURL(new Blob([text], { type: 'application/octet-stream' }));
        element('a', { href: address, download: name }).click();
        setTimeout(() => URL.revokeObjectURL(address), 1000);
      });
      return element('li', {}, [save, ` ${(text.length / 1000).toFixed(1)} kB`]);
    });
    return element('ul', { class: 'files' }, rows);
  }
}
