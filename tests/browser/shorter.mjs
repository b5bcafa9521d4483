// Models with few simulations, for reports of all of them: `node shorter.mjs FILE...` replaces their bounds and leaves out statistics.
import { readFileSync, writeFileSync } from 'node:fs';

/** Whether a line begins an entry of the model that is replaced. @param {string} line */
const isReplaced = (line) => /^(bounds|statistics):/.test(line);

for (const file of process.argv.slice(2)) {
  let leaves = false;
  const kept = readFileSync(file, 'utf8').split('\n').filter((line) => {
    // An entry ends where the next begins.
    if (/^\S/.test(line)) leaves = isReplaced(line);
    return !leaves;
  });
  writeFileSync(file, `${kept.join('\n')}\nbounds: { chebyshev: { order: 1 } }\n`);
}
