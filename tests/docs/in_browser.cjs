// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// The documentation in a browser. Every page that the front page leads to, and some of the classes, at 390 and 1400 px: nothing is wider than the page,
// no formula is left as LaTeX, no script fails, nothing is asked of another host. A word is looked for in all of them. Then "Try it here" is tried, where it was
// built with its program: the example, a motor that lacks nothing, a remedy that is pasted, 10 000 rows in less than 10 s, a recording that is
// dropped on the page, and one that is broken.
//   node in_browser.cjs <chromium> <folder of the pages>
'use strict';
const {spawn} = require('child_process'), fs = require('fs'), os = require('os'), path = require('path');
const [chromium, folder] = process.argv.slice(2);
const pages = path.resolve(folder), profile = fs.mkdtempSync(path.join(os.tmpdir(), 'thermopower_docs_'));
const browser = spawn(chromium, ['--headless', '--no-sandbox', '--disable-gpu', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--remote-debugging-pipe', '--user-data-dir=' + profile, 'about:blank'],
  {stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe']});
let last = 0, rest = '';
const waiting = new Map(), foreign = [], failures = [];
browser.stdio[4].setEncoding('utf8').on('data', text => {
  const messages = (rest + text).split('\0');
  rest = messages.pop();
  for (const one of messages.map(m => JSON.parse(m))) {
    if (one.id) {
      const {resolve, reject} = waiting.get(one.id);
      waiting.delete(one.id);
      if (one.error) reject(new Error(one.error.message));
      else resolve(one.result);
    }
    if (one.method === 'Network.requestWillBeSent' && !/^(file|blob|data|about):/.test(one.params.request.url)) foreign.push(one.params.request.url);
    if (one.method === 'Runtime.exceptionThrown') failures.push(one.params.exceptionDetails.exception?.description || one.params.exceptionDetails.text);
  }
});
let session;
const send = (method, params = {}) => new Promise((resolve, reject) => {
  waiting.set(++last, {resolve, reject});
  browser.stdio[3].write(JSON.stringify({id: last, method, params, ...(session ? {sessionId: session} : {})}) + '\0');
});
const run = async text => {
  const {result, exceptionDetails} = await send('Runtime.evaluate', {expression: text, awaitPromise: true, returnByValue: true});
  if (exceptionDetails) throw new Error(exceptionDetails.exception?.description || exceptionDetails.text);
  return result.value;
};
const open = async name => {
  await send('Page.navigate', {url: 'file://' + path.join(pages, name)});
  for (let i = 0; i < 200; ++i) {
    await new Promise(resolve => setTimeout(resolve, 50));
    if (await run('document.readyState === "complete" && location.href.startsWith("file:")').catch(() => false)) return;
  }
  throw new Error(name + ' does not load');
};
const wide = width => send('Emulation.setDeviceMetricsOverride', {width, height: 900, deviceScaleFactor: 1, mobile: false});
const wrong = [];
const check = (good, text) => { if (!good) wrong.push(text); };
const until = async (text, seconds) => {
  const end = Date.now() + 1000 * seconds;
  while (Date.now() < end) {
    if (await run(text).catch(() => false)) return true;  // a page that is leaving answers nothing
    await new Promise(resolve => setTimeout(resolve, 100));
  }
  return false;
};

const look = async () => {
  const seen = new Set(['index.html']);
  await open('index.html');
  const links = 'JSON.stringify([...document.querySelectorAll(".contents a[href]")].map(a => a.getAttribute("href").split("#")[0]).filter(h => /^[a-z_0-9]+\\.html$/i.test(h)))';
  for (const name of JSON.parse(await run(links))) seen.add(name);
  for (const name of [...seen].filter(n => /^(learn|how_to|explain|reference)\.html$/.test(n))) {
    await open(name);
    for (const one of JSON.parse(await run(links))) seen.add(one);
  }
  // Every twelfth page of a class, each with the example that it must have.
  const classes = fs.readdirSync(pages).filter(n => /^(struct|class)thermopower_1_1[\w]*\.html$/.test(n) && /class="fragment"/.test(fs.readFileSync(path.join(pages, n), 'utf8')));
  check(classes.length > 200, 'only ' + classes.length + ' pages of classes have an example');
  for (const name of classes.filter((_, i) => i % 12 === 0)) seen.add(name);
  let formulas = 0;
  for (const name of seen) {
    await open(name);
    for (const width of [390, 1400]) {
      await wide(width);
      const [across, text, set] = JSON.parse(await run(`JSON.stringify([Math.max(document.documentElement.scrollWidth, document.getElementById('doc-content')?.scrollWidth || 0),
        [...document.querySelectorAll('.contents')].map(c => { const d = c.cloneNode(true); d.querySelectorAll('.katex,pre,code,script,.fragment').forEach(e => e.remove()); return d.textContent; }).join(' '),
        document.querySelectorAll('.katex').length])`));
      check(across <= width, `${name} is ${across} px wide at ${width}`);
      check(!/\\\\\\[(\\[]|\\f\$|\\[([]/.test(text), `${name} shows LaTeX`);
      if (width === 390) formulas += set;
    }
  }
  check(seen.size > 30, 'only ' + seen.size + ' pages were found');
  console.log(`${seen.size} pages, ${formulas} formulas`);
};

// A word that stands in texts is found, in pages of people and of the code, and each page that is named has it.
const find = async () => {
  await open('safety.html');
  check(await until('document.getElementById("MSearchField") !== null', 20), 'there is no search field');
  await run('document.getElementById("MSearchField").value = "limiter"; document.getElementById("MSearchField").dispatchEvent(new KeyboardEvent("keydown", {key: "Enter", bubbles: true, cancelable: true})); 0').catch(() => 0);
  check(await until('location.pathname.endsWith("find.html") && document.querySelectorAll("#find-list li").length > 0', 20), 'Enter in the search field does not find');
  const names = JSON.parse(await run('JSON.stringify([...document.querySelectorAll("#find-list a")].map(a => a.getAttribute("href")))'));
  for (const needed of ['explain_certified_limiter.html', 'choose_a_limiter.html', 'safety.html', 'architecture.html'])
    check(names.includes(needed), 'limiter is not found in ' + needed);
  check(names.some(n => /^classthermopower/.test(n)), 'limiter is found in no class');
  for (const name of names.slice(0, 20)) check(/limiter/i.test(fs.readFileSync(path.join(pages, name), 'utf8')), name + ' has no limiter in it');
  await run('document.getElementById("find-word").value = "no such word anywhere"; document.getElementById("find-word").dispatchEvent(new Event("input")); 0');
  check(await run('document.querySelectorAll("#find-list li").length') === 0, 'a word that is nowhere is found');
  console.log(`"limiter": ${names.length} pages and more`);
};

const press = name => run(`document.getElementById('try-${name}').click()`);
const verdict = 'document.documentElement.dataset.verdict';
const status = () => run('document.getElementById("try-status").textContent');
const diagnose = async seconds => {
  await run(`delete ${verdict}; 0`);
  await press('run');
  await until(`${verdict} || document.getElementById('try-status').className === 'wrong'`, seconds);
  return run(`${verdict} || ''`);
};
const example = async (rows, percent) => {
  await run(`document.getElementById('try-rows').value = ${rows}; document.getElementById('try-tempco').value = ${percent}; 0`);
  await press('example');
  check(await until('!document.getElementById("try-run").disabled && /Two recordings/.test(document.getElementById("try-status").textContent)', 30), 'the example does not come: ' + await status());
};
const attempt = async () => {
  await open('try_it_here.html');
  if (!fs.existsSync(path.join(pages, 'thermopower_gap.js'))) {
    check(/without the program/.test(await status()), 'without its program the page does not say so');
    console.log('Try it here: built without its program, and says so');
    return;
  }
  await example(800, 0.393);
  check(await diagnose(60) === 'explained', 'the example is ' + await run(`${verdict}`) + ': ' + await status());
  const summary = await run('document.getElementById("try-summary").textContent');
  check(/winding_tempco \(\d+ %\): tempco_per_K 0\.0039/.test(summary), 'the cause is not named: ' + summary);
  check(await run('document.getElementById("try-report").srcdoc.includes("<!DOCTYPE html>")'), 'there is no report');
  // A motor that lacks nothing: the model's constants are 2 % off, and then they are right.
  await example(800, 0);
  check(await diagnose(60) === 'explained', 'constants that are off are ' + await run(`${verdict}`) + ': ' + await status());
  const constants = await run('document.getElementById("try-summary").textContent');
  check(/calibration\.resistance/.test(constants) && !/winding_tempco \(/.test(constants), 'of constants that are off: ' + constants);
  await run('(m => { m.value = m.value.replace("12.24", "12").replace("58.8", "60"); })(document.getElementById("try-model")); 0');
  check(await diagnose(60) === 'no_gap', 'a motor that lacks nothing is ' + await run(`${verdict}`) + ': ' + await status());
  await run('(m => { m.value = m.value.replace(" 12,", " 12.24,").replace(" 60,", " 58.8,"); })(document.getElementById("try-model")); 0');
  await example(10000, 0.393);
  const since = Date.now();
  check(await diagnose(60) === 'explained', '10 000 rows are ' + await run(`${verdict}`) + ': ' + await status());
  const seconds = (Date.now() - since) / 1000;
  check(seconds < 10, `10 000 rows take ${seconds} s`);
  console.log(`Try it here: 10 000 rows in ${seconds.toFixed(1)} s (${await status()})`);
  // A recording of one's own: dropped, and its last 30 % held out.
  await press('training-clear');
  await press('held-clear');
  const drop = text => run(`(() => {
    const data = new DataTransfer();
    data.items.add(new File([${JSON.stringify(text)}], 'own.csv', {type: 'text/csv'}));
    document.getElementById('try-training').dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));
  })()`);
  let csv = 't_s,power_param,supply_V,ambient_C,current_A,motor_C\n', motor_C = 20;
  for (let row = 0; row < 400; ++row) {
    // Written apart from the library: V_rms^2 / R, R = 12 (1 + 0.00393 (T - 25)), and Newton's law.
    const power = [40, 200, 120, 240, 0][Math.floor(row / 25) % 5], ohm = 12 * (1 + 0.00393 * (motor_C - 25)), volt = 12 * Math.sqrt(power / 255);
    const shake = [0.31, -0.52, 0.11, 0.77, -0.68, -0.04, 0.42, -0.37][(row * 5 + (row >> 3)) % 8];
    csv += `${5 * row},${power},12,24,${(volt / ohm + 0.004 * shake).toFixed(5)},${(motor_C + 0.1 * shake).toFixed(3)}\n`;
    for (let part = 0; part < 50; ++part) motor_C += 0.1 / 60 * (volt * volt / (12 * (1 + 0.00393 * (motor_C - 25))) - 0.11 * (motor_C - 24));
  }
  await drop(csv);
  check(await until('!document.getElementById("try-run").disabled', 10), 'a dropped recording is not taken');
  await diagnose(60);
  check(/winding_tempco/.test(await run('document.getElementById("try-summary").textContent')), 'of a dropped recording: ' + await status() + await run('document.getElementById("try-summary").textContent'));
  // The same in degrees Fahrenheit: what the finding says to type goes into the field of the columns as it is.
  await run('document.getElementById("try-mapping").value = "--ambient 75.2"; 0');
  await press('training-clear');
  await drop(csv.split('\n').map((line, row) => row === 0 || !line ? line.replace('ambient_C', 'was_C') : line.replace(/[^,]*$/, c => (1.8 * Number(c) + 32).toFixed(3)))
    .join('\n'));
  await until('!document.getElementById("try-run").disabled', 10);
  await diagnose(60);
  const said = await run('document.getElementById("try-summary").textContent.replace(/\\s+/g, " ")');
  const mend = (/To mend it: ((?:--[a-z]+ \S+ ?)+)/.exec(said) || ['', ''])[1];
  check(/motor_C:degF/.test(mend) && /--ambient 24/.test(mend), 'degrees Fahrenheit: ' + said);
  await run(`document.getElementById("try-mapping").value += ${JSON.stringify('\n' + mend)}; 0`);
  await diagnose(60);
  check(/winding_tempco/.test(await run('document.getElementById("try-summary").textContent')), 'the remedy that was pasted (' + mend + '): ' + await status());
  await run('document.getElementById("try-mapping").value = ""; 0');
  await press('training-clear');
  await drop('t_s,power_param\n0,1\n1,abc\n');
  await until('!document.getElementById("try-run").disabled', 10);
  await diagnose(60);
  check(/own\.csv/.test(await status()) && /abc/.test(await status()), 'a broken recording is told as: ' + await status());
};

(async () => {
  const {targetInfos} = await send('Target.getTargets');
  session = (await send('Target.attachToTarget', {targetId: targetInfos.find(t => t.type === 'page').targetId, flatten: true})).sessionId;
  for (const domain of ['Page', 'Runtime', 'Network']) await send(domain + '.enable');
  await look();
  await find();
  await attempt();
  check(foreign.length === 0, 'asked of others: ' + [...new Set(foreign)].slice(0, 5).join(' '));
  check(failures.length === 0, 'scripts fail: ' + [...new Set(failures)].slice(0, 5).join(' | '));
})().catch(error => wrong.push(String(error.stack))).finally(async () => {
  for (const one of wrong) console.error('WRONG: ' + one);
  const ended = new Promise(resolve => browser.once('exit', resolve));
  session = undefined;
  send('Browser.close').catch(() => browser.kill());  // asked to: it ends its children before itself
  await Promise.race([ended, new Promise(resolve => setTimeout(resolve, 5000))]);
  browser.kill('SIGKILL');
  // Its children may write a moment longer; what they leave in the folder for temporary files says nothing about the pages.
  try {
    fs.rmSync(profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 200});
  } catch (error) {
    console.error('left behind: ' + error.message);
  }
  process.exit(wrong.length ? 1 : 0);
});
