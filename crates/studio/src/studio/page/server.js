// @ts-check
// Requests to the studio that serves this page, below the address with its token.

/** What the studio says is wrong. */
export class Refused extends Error {
  /** @param {string} message @param {number} status */
  constructor(message, status) {
    super(message);
    this.status = status;
  }
}

/** @param {Response} response */
async function read(response) {
  const answer = await response.json();
  if (!response.ok) throw new Refused(answer.error || response.statusText, response.status);
  return answer;
}

/** Asks, or says something. @param {string} path @param {unknown} [body] @returns {Promise<any>} */
export async function post(path, body = {}) {
  const response = await fetch(path, { method: 'POST', body: JSON.stringify(body) }).catch(() => {
    throw new Refused('the studio does not answer: it has ended, or is not there any more', 0);
  });
  return read(response);
}

/** Asks the language server about a document. @param {string} method @param {{textDocument: {uri: string}} & Record<string, unknown>} params */
export const language = (method, params) => post('language', { method: `textDocument/${method}`, params });

/** Listens until the studio ends. @param {(topics: Record<string, any>) => void} listener @param {() => void} ended */
export async function listen(listener, ended) {
  let latest = 0;
  for (let failures = 0; failures < 3;) {
    try {
      const answer = await read(await fetch(`events?after=${latest}`));
      failures = 0;
      latest = answer.latest;
      listener(answer.topics);
      if (answer.ended) break;
    } catch {
      failures++;
      await new Promise((done) => setTimeout(done, 300));
    }
  }
  ended();
}

/** Of several wanted answers the latest alone: asks when the one before is there. @template Q, A @param {(question: Q) => Promise<A>} ask @param {(answer: A, question: Q) => void} use @param {(error: Error) => void} failed */
export function latest(ask, use, failed) {
  /** @type {{question: Q} | null} */
  let waiting = null;
  let busy = false;
  const go = async () => {
    busy = true;
    while (waiting) {
      const { question } = waiting;
      waiting = null;
      try {
        const answer = await ask(question);
        if (!waiting) use(answer, question);
      } catch (error) {
        if (!waiting) failed(/** @type {Error} */ (error));
      }
    }
    busy = false;
  };
  return (/** @type {Q} */ question) => {
    waiting = { question };
    if (!busy) go();
  };
}
