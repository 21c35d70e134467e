// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// What makes docs/learn/try-it-here.md do something. The program is text in thermopower_gap.js; a worker made of that text
// runs it, so that the page answers meanwhile. Nothing is asked for and nothing is stored.
(() => {
'use strict';
const find = name => document.getElementById('try-' + name);
const form = find('form');
if (!form) return;
const say = (text, kind) => {
  find('status').textContent = text;
  find('status').className = kind || '';
};
if (typeof thermopower_gap_source !== 'string') {
  find('run').disabled = true;
  say('This copy of the documentation was built without the program: cmake --preset docs-web, with Emscripten.', 'wrong');
  return;
}
const glue = `
let heap;
const ready = new Promise(resolve => { self.Module = {onRuntimeInitialized: resolve, print: () => {}, printErr: () => {}}; });
onmessage = async event => {
  await ready;
  const {task, args, files} = event.data;
  try {
    for (const [name, text] of files || []) Module.FS.writeFile(name, text);
    postMessage({task, result: Module.ccall('thermopower_' + task, 'string', args.map(a => typeof a), args)});
  } catch (error) {
    postMessage({task, failed: String(error && error.message || error)});
  }
};
`;
const address = URL.createObjectURL(new Blob([glue, thermopower_gap_source], {type: 'text/javascript'}));
let worker = null;
const ask = (task, args, files) => new Promise((resolve, reject) => {
  if (!worker) worker = new Worker(address);
  worker.onmessage = event => 'failed' in event.data ? reject(new Error(event.data.failed)) : resolve(event.data.result);
  worker.onerror = event => reject(new Error(event.message || 'the program did not start'));
  worker.postMessage({task, args, files});
});

const kinds = {training: [], held: []};
const show = kind => {
  const list = kinds[kind];
  find(kind + '-files').textContent = list.length
    ? list.map(file => file.name + ' (' + Math.max(1, Math.round(file.text.length / 1024)) + ' KB)').join(', ')
    : kind === 'held' ? 'none: the last 30 % of each recording are held out' : 'none yet';
  find('run').disabled = kinds.training.length === 0;
};
const take = async (kind, files) => {
  for (const file of files) {
    if (/\.json$/i.test(file.name)) find('model').value = await file.text();
    else kinds[kind].push({name: file.name, text: await file.text()});
  }
  show(kind);
};
for (const kind of ['training', 'held']) {
  const place = find(kind), chooser = find(kind + '-choose');
  chooser.addEventListener('change', () => { take(kind, chooser.files); chooser.value = ''; });
  for (const name of ['dragover', 'dragenter'])
    place.addEventListener(name, event => { event.preventDefault(); place.classList.add('over'); });
  place.addEventListener('dragleave', () => place.classList.remove('over'));
  place.addEventListener('drop', event => {
    event.preventDefault();
    place.classList.remove('over');
    take(kind, event.dataTransfer.files);
  });
  find(kind + '-clear').addEventListener('click', () => { kinds[kind] = []; show(kind); });
}
find('example').addEventListener('click', async () => {
  const rows = Math.min(100000, Math.max(50, Number(find('rows').value) || 800)), tempco = Number(find('tempco').value) / 100;
  say('The example runs\u2026');
  try {
    const training = await ask('example', [rows - Math.floor(0.4 * rows), tempco, 1]);
    const held = await ask('example', [Math.floor(0.4 * rows), tempco, 2]);
    kinds.training = [{name: 'example.csv', text: training}];
    kinds.held = [{name: 'example_held_out.csv', text: held}];
    find('model').value = find('model').defaultValue;
    show('training');
    show('held');
    say('Two recordings of a motor whose copper gains ' + find('tempco').value + ' % of resistance a kelvin. The model above does not know that.');
  } catch (error) {
    say(error.message, 'wrong');
  }
});
form.addEventListener('submit', async event => {
  event.preventDefault();
  find('run').disabled = true;
  say('Diagnosing\u2026');
  const files = [['model.json', find('model').value]], paths = kind => kinds[kind].map((file, i) => {
    const name = kinds[kind].findIndex(one => one.name === file.name) === i ? file.name : i + '_' + file.name;
    files.push([kind === 'held' && kinds.training.some(one => one.name === name) ? 'held_out_' + name : name, file.text]);
    return files[files.length - 1][0];
  }).join('\n');
  try {
    const answer = JSON.parse(await ask('diagnose', ['model.json', paths('training'), paths('held')], files));
    if (answer.error) throw new Error(answer.error);
    say(answer.rows + ' rows in ' + answer.seconds.toFixed(1) + ' s, in this page.', 'done');
    find('summary').textContent = answer.summary;
    find('summary').hidden = false;
    find('report').srcdoc = answer.html;
    find('report').hidden = false;
    find('save').hidden = false;
    find('save').href = URL.createObjectURL(new Blob([answer.html], {type: 'text/html'}));
    document.documentElement.dataset.verdict = answer.verdict;
  } catch (error) {
    say(error.message, 'wrong');
    if (worker) worker.terminate();  // what failed may have left anything behind
    worker = null;
  }
  find('run').disabled = kinds.training.length === 0;
});
show('training');
show('held');
say('Take the example, or drop a recording.');
})();
