// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

/// @file io.hpp
/// Reading recordings and models, writing reports, pages, predictions and firmware headers: what the program
/// thermopower-gap does with files, for a program of one's own. Link thermopower::io.
///
/// Firmware must not include it.

#include <thermopower/io/check_report.hpp>
#include <thermopower/io/column_choice.hpp>
#include <thermopower/io/column_list.hpp>
#include <thermopower/io/compare_reports.hpp>
#include <thermopower/io/explain.hpp>
#include <thermopower/io/header_export.hpp>
#include <thermopower/io/input_error.hpp>
#include <thermopower/io/mcap_file.hpp>
#include <thermopower/io/model_file.hpp>
#include <thermopower/io/output_files.hpp>
#include <thermopower/io/predictions_file.hpp>
#include <thermopower/io/recording_file.hpp>
#include <thermopower/io/remedy.hpp>
#include <thermopower/io/provenance.hpp>
#include <thermopower/io/report_html.hpp>
#include <thermopower/io/report_json.hpp>
#include <thermopower/io/sbgc_capture.hpp>
#include <thermopower/io/simulator_export.hpp>
#include <thermopower/io/sentences.hpp>
#include <thermopower/io/summary.hpp>
#include <thermopower/io/text_table.hpp>
