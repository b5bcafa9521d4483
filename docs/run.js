// A button at each model of the book that opens the playground with it and runs it.
for (const code of document.querySelectorAll('pre > code.language-yaml')) {
  const text = code.textContent;
  // Pages of messages show what is wrong, and parts of a model.
  if (!/^model:/m.test(text) || !/^outputs:/m.test(text) || /# [EW]\d{4}/.test(text)) continue;
  const link = document.createElement('a');
  link.className = 'run-model';
  link.href = `${path_to_root}playground.html#run=${encodeURIComponent(text)}`;
  link.textContent = '▶ Run in the playground';
  code.parentElement.after(link);
}
