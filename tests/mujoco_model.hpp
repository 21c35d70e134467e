// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <string>

namespace test {

/// A model of MuJoCo from text, and its state.
struct MujocoModel {
  mjModel* model = nullptr;  ///< null where MuJoCo refused the text
  mjData* data = nullptr;    ///< of the model
  std::string error;         ///< what MuJoCo said

  explicit MujocoModel(const std::string& xml) {
    auto files = std::make_unique<mjVFS>();  // half a megabyte
    mj_defaultVFS(files.get());
    const int at = mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(xml.size()));
    if (at >= 0) std::memcpy(files->filedata[at], xml.data(), xml.size());
    char said[1000] = "";
    if (at >= 0) model = mj_loadXML("model.xml", files.get(), said, sizeof said);
    mj_deleteVFS(files.get());
    error = said;
    if (model != nullptr) data = mj_makeData(model);
  }
  ~MujocoModel() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
  MujocoModel(const MujocoModel&) = delete;
  MujocoModel& operator=(const MujocoModel&) = delete;
};

}  // namespace test
