#!/bin/sh
# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# sh tests/mcdc/mcdc.sh [DIR]   builds the tests of limiters, power-up, faults and codec for MC/DC in DIR (build/mcdc), runs them,
#                               and prints which decisions they have covered. cmake --build <build> --target mcdc does the same.
# Fails when a condition is not covered that tests/mcdc/uncovered.md does not explain, or explains one that is.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$root/build/mcdc}
flags="-fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc"
. "$root/tests/mcdc/tools.sh"

tests="sbgc_test actuator_config actuator_power_up actuator_start_bounds certified_chain certified_limiter certified_invariance certified_measurements certified_coupled
  control_air_temperature control_axis_controller control_config_record control_failures_of_others control_gimbal_controller control_limiter_chain
  control_late_board control_other_battery control_supply_and_time control_told_wrong control_air_witness control_sensor_guard
  control_nodes_and_laws control_position_error control_power_law control_protection control_safety_limiter control_sensor_limiter control_utilisation control_decisions control_refusals actuator_start_decisions actuator_edges actuator_hottest_journal certified_edges
  fixed_point fixed_point_loop"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 \
  "-DCMAKE_CXX_FLAGS=$flags" -DTHERMOPOWER_TESTS=ON -DTHERMOPOWER_STRICT=OFF -DTHERMOPOWER_DESKTOP=OFF -DTHERMOPOWER_TOOLS=OFF -DTHERMOPOWER_EXAMPLES=OFF > "$build/configure.log"
# shellcheck disable=SC2086
cmake --build "$build" --target $tests > "$build/build.log" 2>&1 || { tail -40 "$build/build.log"; exit 1; }
rm -rf "$build/profiles"
objects=""
for test in $tests; do
  LLVM_PROFILE_FILE="$build/profiles/$test.profraw" "$build/bin/$test" > "$build/$test.log" 2>&1 || { tail -40 "$build/$test.log"; exit 1; }
  objects="$objects -object $build/bin/$test"
done
llvm-profdata-19 merge -sparse -o "$build/all.profdata" "$build"/profiles/*.profraw
# shellcheck disable=SC2086
llvm-cov-19 export $objects -instr-profile "$build/all.profdata" > "$build/coverage.json" 2> "$build/export.log"
cd "$root/include/thermopower"
echo "Not held to it, but proved by machine (docs/explain/machine-proofs.md):"
python3 -B "$root/tests/mcdc/table.py" "$build/coverage.json" . - control/certified/*.hpp
echo "Limiters, power-up, faults and codec:"
python3 -B "$root/tests/mcdc/table.py" "$build/coverage.json" . "$root/tests/mcdc/uncovered.md" \
  control/*limiter*.hpp control/fixed_point/*limiter*.hpp control/power_in_force.hpp \
  actuator/power_up.hpp actuator/start_bounds.hpp actuator/stored_state.hpp actuator/record_ring.hpp actuator/hottest_journal.hpp \
  control/air_temperature.hpp control/fixed_point/air_temperature.hpp control/position_error.hpp control/utilisation.hpp \
  control/axis_controller.hpp control/gimbal_controller.hpp control/fixed_point/gimbal_controller.hpp detail/check.hpp \
  sbgc/*.hpp sbgc/detail/*.hpp detail/crc16.hpp
