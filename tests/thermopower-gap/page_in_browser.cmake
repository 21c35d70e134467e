# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# A report's page in a browser, on a telephone and on a desk: nothing is wider than the page, no script fails, and what the
# script adds works. -DCHROMIUM= -DPAGE=
foreach(width 390 1400)
  set(host ${PAGE}.${width}.html)
  file(WRITE ${host} "<!DOCTYPE html><body><iframe id=\"f\" style=\"width:${width}px;height:900px;border:0\"></iframe><pre id=\"o\">not loaded</pre>
<script>
const say = text => { o.textContent = text; };
f.onload = () => { try { look(); } catch (error) { say('WRONG: ' + error); } };
function look() {
  const page = f.contentWindow, d = f.contentDocument, wrong = [];
  const check = (good, text) => { if (!good) wrong.push(text); };
  check(d.documentElement.scrollWidth <= ${width}, 'the page is ' + d.documentElement.scrollWidth + ' px wide');
  const least = Math.min(...[...d.querySelectorAll('body *')].filter(e => e.childNodes.length && [...e.childNodes].some(c => c.nodeType === 3 && c.textContent.trim()) && !e.closest('script,style')).map(e => parseFloat(page.getComputedStyle(e).fontSize)));
  check(least >= 12, 'text of ' + least + ' px');
  check(d.documentElement.classList.contains('js'), 'the script did not start');
  const chart = d.querySelector('.chart[data-group]'), plot = chart.querySelector('.plot');
  const ticks = () => [...plot.querySelectorAll('.gx')].map(t => t.textContent).join(' ');
  const before = ticks();
  [...chart.querySelectorAll('button')].find(b => b.textContent === '+').click();
  check(ticks() !== before, 'zoom changed no tick');
  const other = [...d.querySelectorAll('.chart')].find(c => c !== chart && c.dataset.group === chart.dataset.group);
  check([...other.querySelectorAll('.gx')].map(t => t.textContent).join(' ') === ticks(), 'charts of one run are not zoomed together');
  [...chart.querySelectorAll('button')].find(b => b.textContent === 'show the whole run').click();
  check(ticks() === before, 'the whole run is not what it was');
  // The run is 30 + 0.2 t, as configured 1 more: read from the picture at 25 % of its width, t = 24.75.
  const box = plot.getBoundingClientRect();
  plot.dispatchEvent(new page.PointerEvent('pointermove', {clientX: box.left + box.width / 4, clientY: box.top + 5, bubbles: true}));
  const value = role => parseFloat(chart.querySelector('.key[data-role=' + role + '] em').textContent);
  check(Math.abs(value('measured') - 35) < 0.3, 'measured reads ' + value('measured'));
  check(Math.abs(value('baseline') - value('measured') - 1) < 0.05, 'as configured reads ' + value('baseline'));
  chart.querySelector('.key[data-role=baseline]').click();
  check(page.getComputedStyle(chart.querySelector('.plot .curve.baseline')).display === 'none', 'a curve is not switched off');
  // What was not chosen is drawn when somebody asks, in every picture of it, and goes again.
  const rivals = () => [...d.querySelectorAll('.plot .curve.rival1')].filter(c => page.getComputedStyle(c).display !== 'none').length;
  check(rivals() === 0, 'a rival is drawn unasked');
  d.querySelector('.key.switch[data-role=rival1]').click();
  check(rivals() >= 2, 'a rival is not drawn');
  check([...d.querySelectorAll('.key[data-role=rival1]')].every(k => k.getAttribute('aria-pressed') === 'true'), 'its keys do not say so');
  plot.dispatchEvent(new page.PointerEvent('pointermove', {clientX: box.left + box.width / 4, clientY: box.top + 5, bubbles: true}));
  check(Math.abs(value('rival1') - value('measured') - 0.25) < 0.05, 'the rival reads ' + value('rival1'));
  d.querySelector('.chart .key[data-role=rival1]').click();
  check(rivals() === 0, 'a rival is not switched off');
  // A number of a table stands on one line.
  const lines = e => { const r = d.createRange(); r.selectNodeContents(e); return new Set([...r.getClientRects()].map(b => Math.round(b.top))).size; };
  const broken = [...d.querySelectorAll('.together td:not(.t)')].filter(e => e.textContent && lines(e) !== 1);
  check(broken.length === 0, 'correlations are broken: ' + broken.map(e => e.textContent).join(' '));
  // On an axis of decades the words are numbers, not logarithms.
  const decades = d.querySelector('.chart[data-log]'), spot = decades.querySelector('.plot').getBoundingClientRect();
  decades.querySelector('.plot').dispatchEvent(new page.PointerEvent('pointermove', {clientX: spot.right - 1, clientY: spot.top + 5, bubbles: true}));
  const hertz = parseFloat(decades.querySelector('.xl').textContent.replace('at', ''));
  check(Math.abs(hertz - 0.5) < 0.06, 'the highest frequency reads ' + hertz);
  say(wrong.length ? 'WRONG: ' + wrong.join('; ') : 'ALL WELL');
}
f.contentWindow.addEventListener('error', event => say('WRONG: ' + event.message));
f.src = 'file://${PAGE}';
</script>")
  execute_process(COMMAND ${CHROMIUM} --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
                          --disable-component-update --disable-sync --allow-file-access-from-files --user-data-dir=${PAGE}.profile
                          --virtual-time-budget=5000 --dump-dom file://${host}
                  OUTPUT_VARIABLE dom ERROR_VARIABLE noise RESULT_VARIABLE status TIMEOUT 60)
  if(NOT dom MATCHES "<pre id=\"o\">ALL WELL</pre>")
    string(REGEX MATCH "<pre id=\"o\">[^<]*</pre>" said "${dom}")
    message(FATAL_ERROR "At ${width} px: ${said} (status ${status})\n${noise}")
  endif()
endforeach()
file(REMOVE_RECURSE ${PAGE}.profile)
