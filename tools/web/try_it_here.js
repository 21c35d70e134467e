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
    ? list.map(file => file.name + ' (' + Math.max(1, Math.round(file.bytes.length / 1024)) + ' KB)').join(', ')
    : kind === 'held' ? 'none: the last 30 % of each recording are held out' : 'none yet';
  find('run').disabled = find('columns').disabled = kinds.training.length === 0;
};
// A recording may be of bytes that are no text (MCAP), so that none is read as text.
const bytes_of = text => new TextEncoder().encode(text);
const take = async (kind, files) => {
  for (const file of files) {
    if (/\.json$/i.test(file.name) && file.size < 1e6) find('model').value = await file.text();
    else kinds[kind].push({name: file.name, bytes: new Uint8Array(await file.arrayBuffer())});
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
    kinds.training = [{name: 'example.csv', bytes: bytes_of(training)}];
    kinds.held = [{name: 'example_held_out.csv', bytes: bytes_of(held)}];
    find('model').value = find('model').defaultValue;
    find('mapping').value = '';
    show('training');
    show('held');
    say('Two recordings of a motor whose copper gains ' + find('tempco').value + ' % of resistance a kelvin. The model above does not know that.');
  } catch (error) {
    say(error.message, 'wrong');
  }
});
find('columns').addEventListener('click', async () => {
  const [first] = kinds.training;
  say('Looking at ' + first.name + '\u2026');
  try {
    const answer = JSON.parse(await ask('columns', [first.name], [[first.name, first.bytes]]));
    if (answer.error) throw new Error(answer.error);
    find('mapping').value = answer.mapping;
    find('summary').textContent = answer.text;
    find('summary').hidden = false;
    say('A proposal, from names, units and numbers. Look at it, then diagnose.');
  } catch (error) {
    say(error.message, 'wrong');
  }
});

// One curve between the two simulations: at 0 the effect is off, at 1 it is on.
let curves = [];
const draw = () => {
  const one = curves[find('signal').selectedIndex];
  if (!one) return;
  const share = Number(find('effect').value) / 100, canvas = find('canvas'), scale = window.devicePixelRatio || 1;
  const width = canvas.clientWidth, height = canvas.clientHeight, left = 56, bottom = 22, top = 8;
  canvas.width = width * scale;
  canvas.height = height * scale;
  const pen = canvas.getContext('2d'), ink = getComputedStyle(canvas).color;
  pen.scale(scale, scale);
  const simulated = one.off.map((off, i) => off === null || one.on[i] === null ? null : off + share * (one.on[i] - off));
  const all = [...one.measured, ...one.off, ...one.on].filter(Number.isFinite);
  const low = all.reduce((a, b) => Math.min(a, b), Infinity), high = all.reduce((a, b) => Math.max(a, b), -Infinity);
  const first = one.t_s[0], last = one.t_s[one.t_s.length - 1];
  const x = t => left + (width - left - 8) * (t - first) / (last - first || 1);
  const y = v => top + (height - top - bottom) * (high - v) / (high - low || 1);
  pen.font = '12px system-ui, sans-serif';
  pen.fillStyle = ink;
  for (const value of [low, (low + high) / 2, high]) pen.fillText(Number(value.toPrecision(3)), 4, y(value) + 4);
  pen.fillText(Math.round(first) + ' s', left, height - 6);
  pen.textAlign = 'right';
  pen.fillText(Math.round(last) + ' s', width - 8, height - 6);
  pen.textAlign = 'left';
  const line = (values, color, thick) => {
    pen.strokeStyle = color;
    pen.lineWidth = thick;
    pen.beginPath();
    let on = false;
    values.forEach((value, i) => {
      if (!Number.isFinite(value)) { on = false; return; }
      if (on) pen.lineTo(x(one.t_s[i]), y(value));
      else pen.moveTo(x(one.t_s[i]), y(value));
      on = true;
    });
    pen.stroke();
  };
  line(one.measured, '#888888', 3);
  line(simulated, '#0072b2', 1.5);
  let squares = 0, count = 0;
  simulated.forEach((value, i) => {
    if (!Number.isFinite(value) || !Number.isFinite(one.measured[i])) return;
    squares += (value - one.measured[i]) ** 2;
    ++count;
  });
  find('misfit').textContent = 'RMSE ' + Math.sqrt(squares / count).toPrecision(3) + ' ' + one.unit + ' (grey: measured, blue: simulated)';
};
find('effect').addEventListener('input', draw);
find('signal').addEventListener('change', draw);
window.addEventListener('resize', draw);
const show_curves = list => {
  curves = list;
  find('signal').replaceChildren(...list.map(one => new Option(one.signal + ' / ' + one.unit)));
  find('effect').value = 0;
  find('curves').hidden = list.length === 0;
  draw();
};

form.addEventListener('submit', async event => {
  event.preventDefault();
  find('run').disabled = true;
  say('Diagnosing\u2026');
  const files = [['model.json', find('model').value]], paths = kind => kinds[kind].map((file, i) => {
    const name = kinds[kind].findIndex(one => one.name === file.name) === i ? file.name : i + '_' + file.name;
    files.push([kind === 'held' && kinds.training.some(one => one.name === name) ? 'held_out_' + name : name, file.bytes]);
    return files[files.length - 1][0];
  }).join('\n');
  try {
    const answer = JSON.parse(await ask('diagnose', ['model.json', paths('training'), paths('held'), find('mapping').value], files));
    if (answer.error) throw new Error(answer.error);
    say(answer.rows + ' rows in ' + answer.seconds.toFixed(1) + ' s, in this page.', 'done');
    find('summary').textContent = answer.summary;
    find('summary').hidden = false;
    show_curves(answer.curves);
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
