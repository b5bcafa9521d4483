// Texts of the shipped models and of what examples of the book name, by their paths, as JSON on standard output.
import { readFileSync, readdirSync } from 'node:fs';

const folders = ['models', 'docs/examples/matrices'];
const paths = folders.flatMap((folder) => readdirSync(folder, { recursive: true }).map((name) => `${folder}/${name}`));
const texts = paths.filter((path) => /\.(yaml|urdf|xml)$/.test(path)).sort();
process.stdout.write(JSON.stringify(Object.fromEntries(texts.map((path) => [path, readFileSync(path, 'utf8')]))));
