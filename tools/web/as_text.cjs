// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

// A program as a constant with its text: a page that was opened from a disk may not read a file, but may make a worker of text.
//   node as_text.cjs program.js thermopower_gap.js
'use strict';
const fs = require('fs');
const [from, to] = process.argv.slice(2);
const text = JSON.stringify(fs.readFileSync(from, 'utf8')).replace(/<\//g, '<\\/').replace(/\u2028|\u2029/g, one => '\\u' + one.charCodeAt(0).toString(16));
fs.writeFileSync(to, '"use strict";\nconst thermopower_gap_source = ' + text + ';\n');
