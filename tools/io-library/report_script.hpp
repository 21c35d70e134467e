// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::io {

// What the page's script adds, and nothing that the page needs: values under the pointer, zoom that charts of one
// run share, curves switched on and off in the legend. It reads the numbers back from the drawn paths (see
// to_html() for their units), asks for nothing, and stores nothing.
inline constexpr const char* report_script = R"js(
(() => {
'use strict';
const root = document.documentElement, columns = 1e5, rows = 1e4;
const tickStep = (span, about) => {
  const rough = span / about, power = 10 ** Math.floor(Math.log10(rough));
  for (const factor of [1, 2, 5]) if (factor * power >= rough) return factor * power;
  return 10 * power;
};
const tickText = (value, step) => {
  if (Math.abs(value) < 1e-9 * step) value = 0;
  const text = Math.max(Math.abs(value), step) >= 1e6 || step < 1e-5 ? value.toPrecision(3)
    : value.toFixed(Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)));
  return text.replace('-', '\u2212');
};
const readable = value => {
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2)
    : value.toFixed(size === 0 ? 0 : Math.max(0, 3 - Math.floor(Math.log10(size)) - (size < 1 ? 1 : 0)));
  return text.replace('-', '\u2212');
};

class Chart {
  constructor(element) {
    this.element = element;
    this.plot = element.querySelector('.plot');
    this.svg = this.plot.querySelector('svg');
    this.label = element.querySelector('.xl');
    [this.x0, this.x1] = element.dataset.x.split(' ').map(Number);
    [this.y0, this.y1] = element.dataset.y.split(' ').map(Number);
    this.group = element.dataset.group;
    this.logarithmic = 'log' in element.dataset;
    this.first = this.group ? element.dataset.view.split(' ').map(Number) : [this.x0, this.x1];
    this.view = this.first;
    this.curves = [...this.svg.querySelectorAll('.curve')];
    this.keys = [...element.querySelectorAll('.key[data-role]')];
    this.read = new Map();
    this.time = document.createElement('span');
    this.label.prepend(this.time);
  }
  // Numbers of a path, as [xs, ys] in the data's units; read when somebody first asks.
  numbers(curve) {
    if (!this.read.has(curve)) {
      const xs = [], ys = [];
      for (const piece of curve.getAttribute('d').split('M').slice(1)) {
        const all = piece.match(/-?\d+/g).map(Number);
        let x = 0, y = 0;
        for (let i = 0; i + 1 < all.length; i += 2) {
          x += all[i];
          y += all[i + 1];
          xs.push(this.x0 + x / columns * (this.x1 - this.x0));
          ys.push(this.y1 - y / rows * (this.y1 - this.y0));
        }
      }
      this.read.set(curve, [xs, ys]);
    }
    return this.read.get(curve);
  }
  at(curve, x) {
    const [xs, ys] = this.numbers(curve);
    let low = 0, high = xs.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (xs[middle] <= x) low = middle; else high = middle;
    }
    return xs.length ? ys[x - xs[low] <= xs[high] - x ? low : high] : NaN;
  }
  show(view) {
    this.view = view;
    let low = Infinity, high = -Infinity;
    for (const curve of this.curves) {
      if (getComputedStyle(curve).display === 'none') continue;
      const [xs, ys] = this.numbers(curve);
      for (let i = 0; i < xs.length; ++i)
        if (xs[i] >= view[0] && xs[i] <= view[1]) {
          low = Math.min(low, ys[i]);
          high = Math.max(high, ys[i]);
        }
    }
    if ('zero' in this.element.dataset) {
      low = Math.min(low, 0);
      high = Math.max(high, 0);
    }
    if (!(high > low)) [low, high] = [this.y0, this.y1];
    const margin = 0.06 * (high - low);
    low -= margin;
    high += margin;
    const px = x => (x - this.x0) / (this.x1 - this.x0) * columns;
    const py = y => (this.y1 - y) / (this.y1 - this.y0) * rows;
    this.svg.setAttribute('viewBox', [px(view[0]), py(high), px(view[1]) - px(view[0]), py(low) - py(high)].join(' '));
    this.plot.querySelectorAll('.gx,.gy').forEach(tick => tick.remove());
    const tick = (kind, side, share, text) => {
      const line = document.createElement('i'), word = document.createElement('b');
      line.className = kind;
      line.style[side] = 100 * share + '%';
      word.textContent = text;
      line.append(word);
      this.plot.append(line);
    };
    for (const [x, text] of this.ticks(view[0], view[1], 6))
      tick('gx', 'left', (x - view[0]) / (view[1] - view[0]), text);
    for (const [y, text] of this.ticks(low, high, Math.max(3, Math.floor(this.plot.clientHeight / 36))))
      tick('gy', 'top', (high - y) / (high - low), text);
  }
  // On a logarithmic axis places are logarithms, and words what they are of.
  ticks(from, to, about) {
    const list = [];
    if (this.logarithmic) {
      const decades = Math.max(1, Math.ceil((to - from) / about));
      for (let whole = Math.floor(from / decades) * decades; whole <= to; whole += decades)
        for (const factor of to - from < 2 ? [1, 2, 5] : [1]) {
          const at = whole + Math.log10(factor);
          if (at >= from && at <= to) list.push([at, String(Number((10 ** at).toPrecision(3)))]);
        }
      return list;
    }
    for (let finer = about; list.length < 2 && finer < 4 * about; ++finer) {
      const step = tickStep(to - from, finer);
      list.length = 0;
      for (let at = Math.ceil(from / step) * step; at <= to; at += step) list.push([at, tickText(at, step)]);
    }
    return list;
  }
  word(value) { return readable(this.logarithmic ? 10 ** value : value); }
  point(x) {
    if (!this.cursor) {
      this.cursor = document.createElement('div');
      this.cursor.className = 'cursor';
      this.plot.append(this.cursor);
    }
    const share = (x - this.view[0]) / (this.view[1] - this.view[0]);
    this.cursor.style.display = share >= 0 && share <= 1 ? '' : 'none';
    this.cursor.style.left = 100 * share + '%';
    for (const key of this.keys) {
      const curve = this.curves.find(one => one.classList.contains(key.dataset.role));
      const value = curve ? this.at(curve, x) : NaN;
      if (key.lastChild.nodeName === 'EM') key.lastChild.textContent = Number.isFinite(value) ? this.word(value) : '';
    }
    this.time.textContent = 'at ' + this.word(x) + ' \u00b7 ';
  }
  leave() {
    if (this.cursor) this.cursor.style.display = 'none';
    this.time.textContent = '';
    for (const key of this.keys) if (key.lastChild.nodeName === 'EM') key.lastChild.textContent = '';
  }
}

const charts = [...document.querySelectorAll('.chart[data-x]')].map(element => new Chart(element));
if (!charts.length) return;
root.classList.add('js');
const together = chart => chart.group ? charts.filter(one => one.group === chart.group) : [chart];
// Where the pointer stands: what is under it changes with the zoom.
let pointed = null;
const zoom = (chart, view) => {
  const least = 1e-4 * (chart.x1 - chart.x0), from = Math.max(chart.x0, view[0]), to = Math.min(chart.x1, view[1]);
  if (!(to - from > least)) return;
  together(chart).forEach(one => one.show([from, to]));
  if (pointed && together(chart).includes(pointed.chart)) {
    const x = from + pointed.share * (to - from);
    together(chart).forEach(one => one.point(x));
  }
};
const toggle = role => {
  const off = root.classList.toggle('no-' + role);
  document.querySelectorAll('.key[data-role="' + role + '"]').forEach(key => key.setAttribute('aria-pressed', String(!off)));
  charts.forEach(chart => { if (chart.keys.some(key => key.dataset.role === role)) chart.show(chart.view); });
};
// What was not chosen is drawn when somebody asks for it.
for (const rival of ['rival1', 'rival2', 'rival3']) root.classList.add('no-' + rival);
for (const key of document.querySelectorAll('.key[data-role]')) {
  if (key.querySelector('.curve') === null) continue;
  key.setAttribute('role', 'button');
  key.setAttribute('tabindex', '0');
  key.setAttribute('aria-pressed', String(!root.classList.contains('no-' + key.dataset.role)));
  key.title = 'show or hide';
  if (key.closest('.chart')) key.append(document.createElement('em'));
  key.addEventListener('click', () => toggle(key.dataset.role));
  key.addEventListener('keydown', event => {
    if (event.key !== 'Enter' && event.key !== ' ') return;
    event.preventDefault();
    toggle(key.dataset.role);
  });
}
for (const chart of charts) {
  const plot = chart.plot;
  const at = event => {
    const box = plot.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    return chart.view[0] + share * (chart.view[1] - chart.view[0]);
  };
  let begin = null, marked = null;
  plot.addEventListener('pointermove', event => {
    const x = at(event);
    pointed = {chart, share: (x - chart.view[0]) / (chart.view[1] - chart.view[0])};
    together(chart).forEach(one => one.point(x));
    if (begin === null || !chart.group) return;
    if (!marked) {
      marked = document.createElement('div');
      marked.className = 'sel';
      plot.append(marked);
    }
    const share = value => 100 * (value - chart.view[0]) / (chart.view[1] - chart.view[0]);
    marked.style.left = share(Math.min(begin, x)) + '%';
    marked.style.width = Math.abs(share(x) - share(begin)) + '%';
  });
  const end = event => {
    if (begin !== null && marked) {
      const x = at(event);
      if (event.type === 'pointerup' && Math.abs(x - begin) > 0.01 * (chart.view[1] - chart.view[0]))
        zoom(chart, [Math.min(begin, x), Math.max(begin, x)]);
      marked.remove();
    }
    marked = null;
    begin = null;
  };
  plot.addEventListener('pointerleave', () => {
    pointed = null;
    together(chart).forEach(one => one.leave());
  });
  if (!chart.group) continue;
  plot.addEventListener('pointerdown', event => {
    begin = at(event);
    plot.setPointerCapture(event.pointerId);
  });
  plot.addEventListener('pointerup', end);
  plot.addEventListener('pointercancel', end);
  plot.addEventListener('dblclick', () => zoom(chart, [chart.x0, chart.x1]));
  const button = (text, title, act) => {
    const one = document.createElement('button');
    one.type = 'button';
    one.textContent = text;
    one.title = title;
    one.addEventListener('click', act);
    chart.label.prepend(one);
  };
  if (together(chart)[0] !== chart) continue;
  button('show the whole run', 'or double-click the picture; drag across it to see a part', () => zoom(chart, [chart.x0, chart.x1]));
  button('\u2212', 'see more time', () => {
    const more = 0.5 * (chart.view[1] - chart.view[0]);
    zoom(chart, [chart.view[0] - more, chart.view[1] + more]);
  });
  button('+', 'see less time', () => {
    const less = 0.25 * (chart.view[1] - chart.view[0]);
    zoom(chart, [chart.view[0] + less, chart.view[1] - less]);
  });
}
})();
)js";

}  // namespace thermopower::io
