# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# A report's page in a browser, on a telephone and on a desk: nothing is wider than the page, no script fails, and what the
# script adds works. -DCHROMIUM= -DPAGE=
foreach(width 390 1400)
  set(host ${PAGE}.${width}.html)
  file(WRITE ${host} "<!DOCTYPE html><body><iframe id=\"f\" style=\"width:${width}px;height:900px;border:0\"></iframe><pre id=\"o\">not loaded</pre>
<script>
const say = text => { o.textContent = text; };
f.onload = () => {
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
  [...chart.querySelectorAll('button')].find(b => b.textContent === 'whole run').click();
  check(ticks() === before, 'the whole run is not what it was');
  // The run is 30 + 0.2 t, as configured 1 more: read from the picture at 25 % of its width, t = 24.75.
  const box = plot.getBoundingClientRect();
  plot.dispatchEvent(new page.PointerEvent('pointermove', {clientX: box.left + box.width / 4, clientY: box.top + 5, bubbles: true}));
  const value = role => parseFloat(chart.querySelector('.key[data-role=' + role + '] em').textContent);
  check(Math.abs(value('measured') - 35) < 0.3, 'measured reads ' + value('measured'));
  check(Math.abs(value('baseline') - value('measured') - 1) < 0.05, 'as configured reads ' + value('baseline'));
  chart.querySelector('.key[data-role=baseline]').click();
  check(page.getComputedStyle(chart.querySelector('.plot .curve.baseline')).display === 'none', 'a curve is not switched off');
  say(wrong.length ? 'WRONG: ' + wrong.join('; ') : 'ALL WELL');
};
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
