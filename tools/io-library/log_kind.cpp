// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "log_text.hpp"

#include <thermopower/io/input_error.hpp>

#include "file_source.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace thermopower::io {
namespace {

bool starts(const std::string& text, const std::string& with, std::size_t at = 0) {
  return text.size() >= at + with.size() && text.compare(at, with.size(), with) == 0;
}

bool ends(const std::string& text, const std::string& with) {
  return text.size() >= with.size() && text.compare(text.size() - with.size(), with.size(), with) == 0;
}

// Two lines of Python that make a CSV table of a file that only a library of Python reads.
[[noreturn]] void refuse(const std::string& name, const std::string& what, const std::string& import,
                         const std::string& convert) {
  throw InputError(name + ": is " + what +
                   ", which is not read here; these lines of Python make a CSV table of it:\n    " + import +
                   "\n    " + convert);
}

std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

// Formats whose library is one of Python's.
void refuse_others(const std::string& name, const std::string& head) {
  const std::string file = in_quotes(name),
                    out = in_quotes(std::filesystem::path(name).stem().string() + ".csv");
  const std::string frame_to_csv = ".to_csv(" + out + ", index=False)";
  if (starts(head, "PAR1"))
    refuse(
        name, "a Parquet file (LeRobot, pandas)", "import pandas as pd; d = pd.read_parquet(" + file + ")",
        "pd.concat([pd.DataFrame(d[c].tolist(), index=d.index).add_prefix(c + '.') if hasattr(d[c].iloc[0], '__len__') and not "
        "isinstance(d[c].iloc[0], str) else d[c] for c in d], axis=1).rename(columns={'episode_index': 'run'})" +
            frame_to_csv);
  if (starts(head, "ARROW1") || starts(head, "FEA1"))
    refuse(name, "an Arrow or Feather file", "import pandas",
           "pandas.read_feather(" + file + ")" + frame_to_csv);
  if (starts(head, "\x89HDF\r\n") || starts(head, "MATLAB 7.3"))
    refuse(name, starts(head, "M") ? "a MATLAB file of version 7.3" : "an HDF5 file", "import h5py, pandas",
           "f = h5py.File(" + file +
               "); pandas.DataFrame({k: f[k][()].ravel() for k in f if hasattr(f[k], 'shape')})" +
               frame_to_csv);
  if (starts(head, "MATLAB 5.0"))
    refuse(name, "a MATLAB file", "import scipy.io, pandas",
           "pandas.DataFrame({k: v.ravel() for k, v in scipy.io.loadmat(" + file +
               ").items() if k[0] != '_'})" + frame_to_csv);
  if (starts(head, "#ROSBAG V"))
    refuse(
        name, "a bag of ROS 1",
        "from rosbags.highlevel import AnyReader; import pathlib  # pip install rosbags",
        "r = AnyReader([pathlib.Path(" + file + ")]); r.open(); open(" + out +
            ", 'w').writelines(['t_s,position,velocity,effort\\n'] + [f'{t*1e-9},{m.position[0]},{m.velocity[0]},{m.effort[0]}\\n' for c, t, d in "
            "r.messages() if c.topic == '/joint_states' for m in [r.deserialize(d, c.msgtype)]])");
  if (starts(head, "MDF     ") || starts(head, "UnFinMF "))
    refuse(name, "an MDF file (.mf4)", "import asammdf  # pip install asammdf",
           "asammdf.MDF(" + file +
               ").to_dataframe(raster=0.001, time_from_zero=True).rename_axis('t_s').to_csv(" + out + ")");
  if (starts(head, "TDSm"))
    refuse(name, "a TDMS file of LabVIEW", "import nptdms  # pip install nptdms",
           "nptdms.TdmsFile.read(" + file + ").as_dataframe(time_index=True).rename_axis('t_s').to_csv(" +
               out + ")");
  if (starts(head, "LOGG"))
    refuse(name, "a BLF file of a CAN bus", "import can  # pip install python-can",
           "w = can.CanutilsLogWriter('can.log'); [w(m) for m in can.BLFReader(" + file + ")]; w.stop()");
  if (starts(head, "ULog\x01\x12\x35"))
    refuse(name, "a ULog file of PX4", "import pyulog  # pip install pyulog",
           "d = pyulog.ULog(" + file +
               ").get_dataset('actuator_outputs').data; import pandas; pandas.DataFrame(d)" + frame_to_csv);
  if (ends(name, ".pt") || ends(name, ".pth"))
    refuse(
        name, "a file of PyTorch (.pt)",
        "import torch, pandas; d = torch.load(" + file + ", map_location='cpu')",
        "pandas.DataFrame({f'{k}[{i}]': c for k, v in d.items() for i, c in enumerate(v.reshape(len(v), -1).T.numpy())})" +
            frame_to_csv);
  if (starts(head, std::string("\x80\x04", 2)) || starts(head, std::string("\x80\x05", 2)) ||
      starts(head, std::string("\x80\x03", 2)))
    refuse(name, "a pickle of Python", "import pandas  # only of a source that you trust",
           "pandas.DataFrame(pandas.read_pickle(" + file + "))" + frame_to_csv);
  if (starts(head, "\x93NUMPY"))
    refuse(name, "an array of numpy (.npy)", "import numpy",
           "numpy.savez(" + in_quotes(name + ".npz") + ", x=numpy.load(" + file + "))");
  if (starts(head, "\x28\xb5\x2f\xfd"))
    throw InputError(name + ": is packed with zstd; expected the file itself ('zstd -d' unpacks it)");
}

bool is_json_line(const std::string& head) {
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string::npos && head[first] == '{' && head.find('"', first) != std::string::npos;
}

// `(1700000000.000000) can0 141#A100` or `  can0  141   [8]  A1 00`.
bool is_can_line(const std::string& line) {
  char interface[32], frame[80];
  double time = 0.0;
  if (std::sscanf(line.c_str(), " (%lf) %31s %79s", &time, interface, frame) == 3 &&
      std::strchr(frame, '#') != nullptr)
    return true;
  unsigned id = 0, size = 0;
  return std::sscanf(line.c_str(), " (%lf) %31s %x [%u]", &time, interface, &id, &size) == 4 ||
         std::sscanf(line.c_str(), " %31s %x [%u]", interface, &id, &size) == 3;
}

// ` T:210.0 /210.0`
bool has_marlin_report(const std::string& line) {
  for (std::size_t at = line.find("T:"); at != std::string::npos; at = line.find("T:", at + 1)) {
    if (at > 0 && line[at - 1] != ' ' && line[at - 1] != '\t') continue;
    double now = 0.0, target = 0.0;
    if (std::sscanf(line.c_str() + at, "T:%lf /%lf", &now, &target) == 2) return true;
  }
  return false;
}

bool is_klippy_line(const std::string& line) {
  double time = 0.0;
  return std::sscanf(line.c_str(), "Stats %lf:", &time) == 1;
}

}  // namespace

LogKind kind_of_log(const std::string& name, const char* bytes, std::size_t size) {
  const std::string head(bytes, size);
  if (starts(head, "SQLite format 3")) return LogKind::sqlite_bag;
  if (starts(head, "PK\x03\x04") && (ends(name, ".npz") || head.find(".npy") != std::string::npos))
    return LogKind::numpy;
  refuse_others(name, head);
  if (is_json_line(head)) return LogKind::json_lines;
  std::size_t begin = 0;
  for (std::size_t line_number = 0; begin < head.size(); ++line_number) {
    const std::size_t end = std::min(head.find('\n', begin), head.size());
    const std::string line = head.substr(begin, end - begin);
    if (line_number == 0 && is_can_line(line)) return LogKind::candump;
    if (is_klippy_line(line)) return LogKind::klippy;
    if (has_marlin_report(line)) return LogKind::marlin;
    begin = end + 1;
  }
  return starts(head, "Starting Klippy") || head.find("\nStarting Klippy") != std::string::npos
             ? LogKind::klippy
             : LogKind::csv;
}

LogKind kind_of_log(const std::string& path) {
  std::error_code status;
  // What is no plain file gives its bytes once, and is a table.
  if (path == "-" || !std::filesystem::is_regular_file(path, status)) return LogKind::csv;
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) return LogKind::csv;
  std::string head(65536, '\0');
  head.resize(std::fread(&head[0], 1, head.size(), file));
  std::fclose(file);
  return kind_of_log(path, head.data(), head.size());
}

std::string all_bytes_of(const std::string& path) {
  FileSource source(path);
  const ByteSource read = source.function();
  std::string bytes;
  std::array<unsigned char, 65536> block;
  for (;;) {
    const std::size_t got = read(block.data(), block.size());
    bytes.append(reinterpret_cast<const char*>(block.data()), got);
    if (got < block.size()) return bytes;
  }
}

std::string csv_row(const std::vector<std::string>& cells) {
  std::string row;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) row += ',';
    if (cells[i].find_first_of(",\"\n\r") == std::string::npos &&
        (i > 0 || cells[i].empty() || cells[i][0] != '#')) {
      row += cells[i];
      continue;
    }
    row += '"';
    for (const char c : cells[i]) row += c == '"' ? "\"\"" : std::string(1, c);
    row += '"';
  }
  return row + "\n";
}

std::string csv_number(double value) {
  if (!std::isfinite(value)) return {};
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

}  // namespace thermopower::io
