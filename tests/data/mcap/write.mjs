// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
//
// Writes the recordings in this folder with the writers of others: MCAP with @mcap/core, CDR with
// @foxglove/rosmsg2-serialization, chunks packed by the programs zstd and lz4. Run once, by hand:
//
//     npm install && node write.mjs
//
// Every number is also written into a CSV file, in JavaScript's shortest form, which reads back as the same double.

import { McapWriter } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { ros2jazzy } from "@foxglove/rosmsg-msgs-common";
import { execFileSync } from "node:child_process";
import { writeFileSync } from "node:fs";

// The definitions as ROS 2 gives them to a recorder: that of the message, then of all types it uses.
function definition(type) {
  const text = (name) => {
    const lines = ros2jazzy[name].definitions.map((field) =>
      field.isConstant
        ? `${field.type} ${field.name}=${field.valueText ?? field.value}`
        : `${field.type === "time" ? "builtin_interfaces/Time" : field.type}${field.isArray ? `[${field.arrayLength ?? ""}]` : ""} ${field.name}`);
    return lines.join("\n") + "\n";
  };
  const known = [type];
  for (const name of known)
    for (const field of ros2jazzy[name].definitions)
      if (field.isComplex && !known.includes(field.type)) known.push(field.type);
  const next = (name) => `${"=".repeat(80)}\nMSG: ${name}\n`;
  const all = known.map((name, i) => (i === 0 ? "# as recorded\n" : next(name)) + text(name)).join("");
  const stamped = all.includes("builtin_interfaces/Time");
  return all + (stamped ? next("builtin_interfaces/Time") + "# a time\nint32 sec\n\nuint32 nanosec  # from 0 on\n" : "");
}

// A small generator of its own, so that the files are the same each time.
let state = 12345;
function random() {
  state = (Math.imul(state, 1103515245) + 12345) >>> 0;
  return state / 4294967296;
}

const start = 1700000000n * 1000000000n;
const zeros = (n) => new Array(n).fill(0);

// What happened: [time in ns from the start, topic, message].
function events(stamped) {
  const list = [];
  const header = (ns, frame) => {
    const t = start + BigInt(ns) - 2000000n;  // measured two milliseconds before it was recorded
    return { stamp: { sec: Number(t / 1000000000n), nanosec: Number(t % 1000000000n) }, frame_id: frame };
  };
  for (let i = 0; i < 120; i++) {
    const ns = 1000000 + i * 10000000 + Math.floor(random() * 400000);
    const elbow = 0.3 * Math.sin(i / 9) + 1e-4 * random(), wrist = random();
    const turned = i % 7 === 3;  // drivers may tell the joints in another order at any time
    const both = (a, b) => (turned ? [b, a] : [a, b]);
    list.push([ns, "/joint_states", {
      header: header(ns, "arm"), name: both("elbow", "wrist"), position: both(elbow, wrist),
      velocity: both(Math.cos(i / 9) / 30 + 1e-5 * random(), i === 50 ? NaN : -wrist), effort: []}]);
    if (i % 2 === 0) {
      const at = ns + 3000000;
      const v = [random(), random(), random()];
      list.push([at, "/imu", {
        header: header(at, "hand"), orientation: { x: 0, y: 0, z: 0, w: 1 }, orientation_covariance: zeros(9),
        angular_velocity: { x: v[0], y: v[1], z: i === 60 ? NaN : v[2] }, angular_velocity_covariance: zeros(9),
        linear_acceleration: { x: 0.1, y: -0.2, z: 9.81 }, linear_acceleration_covariance: zeros(9)}]);
    }
    if (i % 5 === 0) {
      const at = ns + 1234567;
      list.push([at, "/motor/temperature", { header: header(at, "motor"), temperature: 25 + i / 16, variance: 0 }]);
    }
    if (i % 20 === 1) {
      const at = ns + 777;
      list.push([at, "/battery", {
        header: header(at, ""), voltage: Math.fround(12.6 - i / 300), temperature: Math.fround(30), current: Math.fround(-1.25),
        charge: NaN, capacity: NaN, design_capacity: NaN, percentage: Math.fround(0.5), power_supply_status: 2,
        power_supply_health: 1, power_supply_technology: 3, present: true, cell_voltage: [Math.fround(4.2), Math.fround(4.1), Math.fround(4.15)],
        cell_temperature: [], location: "back", serial_number: "äöü-7"}]);
    }
    if (!stamped && i % 3 === 0) list.push([ns + 5000000, "/elbow/command", { data: 2 * random() - 1 }]);
  }
  return list.sort((a, b) => a[0] - b[0]);
}

const types = {
  "/joint_states": "sensor_msgs/msg/JointState",
  "/imu": "sensor_msgs/msg/Imu",
  "/motor/temperature": "sensor_msgs/msg/Temperature",
  "/battery": "sensor_msgs/msg/BatteryState",
  "/elbow/command": "std_msgs/msg/Float64",
};

async function write(file, list, { encoding, chunks, compression, chunkSize = 4096 }) {
  let bytes = new Uint8Array();
  const writable = {
    position: () => BigInt(bytes.length),
    write: async (more) => {
      const joined = new Uint8Array(bytes.length + more.length);
      joined.set(bytes);
      joined.set(more, bytes.length);
      bytes = joined;
    },
  };
  const pack = { zstd: ["zstd", ["-q", "-c"]], lz4: ["lz4", ["-q", "-c"]] }[compression];
  const writer = new McapWriter({
    writable, useChunks: chunks, chunkSize,
    compressChunk: pack && ((data) => ({ compression, compressedData: execFileSync(pack[0], pack[1], { input: data }) })),
  });
  await writer.start({ profile: encoding === "cdr" ? "ros2" : "", library: "write.mjs" });
  const channels = {}, writers = {};
  for (const topic of [...new Set(list.map((event) => event[1]))]) {
    const text = encoding === "cdr" ? definition(types[topic].replace("/msg/", "/")) : JSON.stringify({ type: "object" });
    const schemaId = await writer.registerSchema({
      name: types[topic], encoding: encoding === "cdr" ? "ros2msg" : "jsonschema", data: new TextEncoder().encode(text) });
    channels[topic] = await writer.registerChannel({ schemaId, topic, messageEncoding: encoding, metadata: new Map([["a", "b"]]) });
    if (encoding === "cdr") writers[topic] = new MessageWriter(parse(text, { ros2: true }));
  }
  const json = (message) => new TextEncoder().encode(JSON.stringify(message, (key, value) => (Number.isNaN(value) ? null : value)));
  let sequence = 0;
  for (const [ns, topic, message] of list) {
    await writer.addMessage({
      channelId: channels[topic], sequence: sequence++, logTime: start + BigInt(ns), publishTime: start + BigInt(ns) - 100000n,
      data: encoding === "cdr" ? writers[topic].writeMessage(message) : json(message) });
  }
  await writer.addAttachment({ name: "note.txt", logTime: start, createTime: start, mediaType: "text/plain", data: new TextEncoder().encode("a note") });
  await writer.addMetadata({ name: "robot", metadata: new Map([["serial", "7"]]) });
  await writer.end();
  writeFileSync(file, bytes);
}

// The same as a table: a row at each time at which anything is recorded, measured values in their own rows alone, all else
// held, nothing before all that is held is known.
function csv(file, list, time, held) {
  const names = ["t", "angle", "rate", "gyro", "temp", "volts", "amps"];
  const now = {};
  const rows = [];
  let zero;
  const sample = {
    "/joint_states": (m) => ({ angle: m.position[m.name.indexOf("elbow")], rate: m.velocity[m.name.indexOf("wrist")] }),
    "/imu": (m) => ({ gyro: m.angular_velocity.z }),
    "/motor/temperature": (m) => ({ temp: m.temperature }),
    "/battery": (m) => ({ volts: m.voltage }),
    "/elbow/command": (m) => ({ amps: m.data }),
  };
  for (const [ns, topic, message] of list) {
    const values = sample[topic](message);
    for (const name of held) if (name in values) now[name] = values[name];
    if (held.some((name) => !(name in now))) continue;
    zero ??= ns;
    const row = { t: (ns - zero) / 1e9, ...Object.fromEntries(held.map((name) => [name, now[name]])), ...values };
    rows.push(names.map((name) => (row[name] === undefined || Number.isNaN(row[name]) ? "" : String(row[name]))).join(","));
  }
  writeFileSync(file, names.join(",") + "\n" + rows.join("\n") + "\n");
}

const arm = events(false), stamped = events(true);
await write("cdr_plain.mcap", arm, { encoding: "cdr", chunks: false });
await write("cdr_chunks.mcap", arm, { encoding: "cdr", chunks: true, compression: "" });
await write("cdr_zstd.mcap", arm, { encoding: "cdr", chunks: true, compression: "zstd" });
await write("cdr_lz4.mcap", arm, { encoding: "cdr", chunks: true, compression: "lz4" });
await write("json_zstd.mcap", arm, { encoding: "json", chunks: true, compression: "zstd" });
await write("json_plain.mcap", arm.slice(0, 40), { encoding: "json", chunks: false });
await write("stamped_lz4.mcap", stamped, { encoding: "cdr", chunks: true, compression: "lz4", chunkSize: 100000 });
csv("arm.csv", arm, "log", ["gyro", "volts", "amps"]);
csv("stamped.csv", stamped, "stamp", ["gyro", "volts"]);
