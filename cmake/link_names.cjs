// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// Names of classes that stand in code font become links to their pages, wherever they stand: Doxygen does that in prose only.
//   node link_names.cjs <folder of the pages>    fails where a policy in the menus has no page
'use strict';
const fs = require('fs'), path = require('path'), vm = require('vm');
const folder = process.argv[2];

// Doxygen's index of its search knows every name, its page, and the scope it is in.
const known = new Map();
for (const file of fs.readdirSync(path.join(folder, 'search')).filter(one => /^(classes|typedefs|enums)_\w+\.js$/.test(one))) {
  const index = {};
  vm.runInNewContext(fs.readFileSync(path.join(folder, 'search', file), 'utf8'), index);
  for (const [, [name, ...places]] of index.searchData)
    for (const [url, , scope] of places) {
      const plain = name.replace(/&lt;.*|<.*/, '');
      // A page of a class says in its name where that is; of several places of one name the index does not.
      const own = /^(?:\.\.\/)?(?:struct|class)(.*)\.html$/.exec(url);
      const space = own ? own[1].replace(/_1_1/g, '::').replace(/__/g, '_').replace(/::[^:]*$/, '') : scope || '';
      // What stands in a class is that class's own: every second one has a Config.
      if (/<|&lt;/.test(name) || !/^thermopower(::[a-z_]+)*$/.test(space)) continue;
      if (!known.has(plain)) known.set(plain, []);
      known.get(plain).push({space, url: url.replace(/^\.\.\//, '')});
    }
}

const scope_of = page => {
  const match = /^(?:struct|class|namespace)(thermopower.*)\.html$/.exec(page);
  return match ? match[1].replace(/_1_1/g, '::').replace(/__/g, '_').replace(/::[A-Z].*/, '') : 'thermopower';
};
// The place of a name as a page means it: in its own scope, in the library's, or in the only other one there is. The wire's
// names are everyday words, and count only where the page is the wire's, or says so.
const place_of = (text, scope) => {
  const match = /^(?:tp::|thermopower::)?((?:[a-z_]+::)*)([A-Z]\w+)(?:&lt;.*&gt;)?$/.exec(text);
  if (!match || !known.has(match[2])) return null;
  const places = known.get(match[2]), space = match[1].replace(/::$/, '');
  const in_space = wanted => places.find(one => one.space === wanted);
  if (space) return places.find(one => one.space.endsWith('::' + space)) || null;
  if (/^(tp|thermopower)::/.test(text)) return in_space('thermopower') || null;
  const others = places.filter(one => one.space !== 'thermopower::sbgc' && one.space !== 'thermopower::fixed_point');
  return in_space(scope) || in_space('thermopower') || (others.length === 1 ? others[0] : null);
};

let linked = 0;
const missing = [];
for (const page of fs.readdirSync(folder).filter(one => one.endsWith('.html'))) {
  const file = path.join(folder, page), html = fs.readFileSync(file, 'utf8'), begin = html.indexOf('<div class="contents">');
  if (begin < 0) continue;
  let scope = scope_of(page), anchors = 0, cell = 0;
  const parts = html.slice(begin).split(/(<code>[^<]*<\/code>|<[^>]*>)/);
  for (let i = 0; i < parts.length; ++i) {
    const part = parts[i], code = /^<code>([^<]*)<\/code>$/.exec(part);
    if (/^<a[ >]/.test(part)) ++anchors;
    else if (part === '</a>') --anchors;
    else if (/^<tr/.test(part)) cell = 0;
    else if (/^<td/.test(part)) ++cell;
    // A menu in whole numbers, on the page of all menus.
    else if (page === 'policies.html' && /^<h[12]/.test(part)) scope = '';
    else if (page === 'policies.html' && scope === '' && /\S/.test(part) && part[0] !== '<')
      scope = part.includes('fixed_point') ? 'thermopower::fixed_point' : 'thermopower';
    if (!code || anchors > 0) continue;
    const place = place_of(code[1], scope);
    if (place && place.url.split('#')[0] !== page) {
      parts[i] = '<code><a class="el" href="' + place.url + '">' + code[1] + '</a></code>';
      ++linked;
    } else if (!place && page === 'policies.html' && cell === 1) missing.push(code[1]);
  }
  fs.writeFileSync(file, html.slice(0, begin) + parts.join(''));
}
console.log(linked + ' names in code font are links');
if (missing.length > 0 || linked === 0) {
  console.error('thermopower: no page for what the menus name: ' + missing.join(', '));
  process.exit(1);
}
