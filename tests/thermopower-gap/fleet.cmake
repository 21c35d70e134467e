# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# cmake -DPROGRAM=<thermopower-gap> -DHERE=<folder> -P fleet.cmake: a fleet gives the same bytes for one worker, for three, and when
# it is killed on the way and resumed, or two of the same command share it; broken logs cost themselves alone.
file(REMOVE_RECURSE ${HERE})
file(MAKE_DIRECTORY ${HERE}/logs)
file(WRITE ${HERE}/model.json [[{"format": "thermopower-model/1", "name": "motor", "supply": {"nominal_V": 13.0},
 "current": {"law": "ohmic", "resistance_ohm": 8.2, "tempco_per_K": 0.0039, "reference_C": 25.0},
 "thermal": {"law": "lumped", "heat_capacity_J_per_K": 60.0, "conductance_W_per_K": 0.11}}]])
# Logs too short for a diagnosis: what is tested here is who does what, and that costs nothing.
set(manifest "log,model,unit\n")
foreach(log RANGE 1 8)
  set(rows "t_s,power_param,ambient_C,motor_C,current_A\n")
  math(EXPR last "2 + ${log} % 3")
  foreach(row RANGE 0 ${last})
    string(APPEND rows "${row},100,25,2${row}.${log},1\n")
  endforeach()
  file(WRITE ${HERE}/logs/run${log}.csv "${rows}")
  string(APPEND manifest "logs/run${log}.csv,model.json,\"unit, ${log}\"\n")
endforeach()
file(WRITE ${HERE}/logs/broken.csv "t_s,motor_C\n0,1\n1,x\n")
file(WRITE ${HERE}/sound.csv "${manifest}")
file(WRITE ${HERE}/manifest.csv "${manifest}logs/broken.csv,model.json,9\nlogs/missing.csv,model.json,10\n")

function(run status)
  execute_process(COMMAND ${PROGRAM} fleet ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
  if(NOT result EQUAL status)
    message(FATAL_ERROR "${ARGN}: exit status ${result}, expected ${status}\n${output}${error}")
  endif()
  set(output "${output}" PARENT_SCOPE)
  set(error "${error}" PARENT_SCOPE)
endfunction()
function(expect text what)
  if(NOT text MATCHES "${what}")
    message(FATAL_ERROR "expected '${what}' in:\n${text}")
  endif()
endfunction()
# Every file of a folder with its contents.
function(contents folder result)
  file(GLOB_RECURSE files RELATIVE ${folder} ${folder}/*)
  list(SORT files)
  set(all "")
  foreach(file IN LISTS files)
    file(SHA256 ${folder}/${file} sum)
    string(APPEND all "${file} ${sum}\n")
  endforeach()
  set(${result} "${all}" PARENT_SCOPE)
endfunction()

run(0 ${HERE}/sound.csv --out ${HERE}/one --workers 1)
expect("${output}" "8 logs: 0 reports were there, 8 are new, 0 have none")
expect("${output}" "insufficient +8")
contents(${HERE}/one one)
string(REGEX MATCHALL "reports/[^ ]*json" reports "${one}")
list(LENGTH reports count)
if(NOT count EQUAL 8)
  message(FATAL_ERROR "expected 8 reports:\n${one}")
endif()
run(0 ${HERE}/sound.csv --out ${HERE}/three --workers 3)
contents(${HERE}/three three)
# Killed at some point, then resumed by the same command; and once more, when nothing is left to do.
execute_process(COMMAND ${PROGRAM} fleet ${HERE}/sound.csv --out ${HERE}/killed --workers 2 TIMEOUT 0.4 OUTPUT_QUIET ERROR_QUIET)
run(0 ${HERE}/sound.csv --out ${HERE}/killed --workers 2)
run(0 ${HERE}/sound.csv --out ${HERE}/killed --workers 2)
expect("${output}" "8 reports were there, 0 are new")
contents(${HERE}/killed killed)
if(NOT one STREQUAL three OR NOT one STREQUAL killed)
  message(FATAL_ERROR "the results differ:\none worker\n${one}three workers\n${three}killed and resumed\n${killed}")
endif()

# Two of the same command at once, each with an output of its own: whichever ends first must not close the other's.
execute_process(COMMAND sh -c "\"$0\" fleet \"$1\" --out \"$2\" --workers 1 >\"$2.first\" & first=$!
                               \"$0\" fleet \"$1\" --out \"$2\" --workers 1 >\"$2.second\" && wait $first"
                        ${PROGRAM} ${HERE}/sound.csv ${HERE}/shared
                RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE error)
contents(${HERE}/shared shared)
if(NOT one STREQUAL shared OR NOT status EQUAL 0)
  message(FATAL_ERROR "two commands that share a fleet: exit ${status}\n${output}${error}\none worker\n${one}\nshared\n${shared}")
endif()
# A unit's logs are one unit; without pages there are none.
file(READ ${HERE}/one/units.csv units)
expect("${units}" "\n\"?unit, 1|^unit,logs")
file(WRITE ${HERE}/bare.csv "${manifest}")
run(0 ${HERE}/bare.csv --out ${HERE}/bare --no-pages)
file(GLOB pages ${HERE}/bare/reports/*.html)
if(pages)
  message(FATAL_ERROR "expected no pages: ${pages}")
endif()
file(READ ${HERE}/bare/logs.csv bare)
file(READ ${HERE}/one/logs.csv whole)
if(NOT bare STREQUAL whole)
  message(FATAL_ERROR "without pages:\n${bare}\nwith them:\n${whole}")
endif()
# Every table of the database is what the reference says.
if(SQLITE AND EXISTS ${HERE}/one/fleet.sqlite)
  execute_process(COMMAND ${SQLITE} ${HERE}/one/fleet.sqlite "SELECT count(*), sum(verdict = 'insufficient') FROM log" OUTPUT_VARIABLE count)
  expect("${count}" "^8.8\n$")
  execute_process(COMMAND ${SQLITE} ${HERE}/one/fleet.sqlite "SELECT m.name, c.name FROM sqlite_master m JOIN pragma_table_info(m.name) c WHERE m.type = 'table'"
                  OUTPUT_VARIABLE columns)
  file(STRINGS ${REFERENCE} rows REGEX "^\\| `[a-z_]+` \\| ")
  set(told 0)
  string(REGEX MATCHALL "[^\n]+" columns "${columns}")
  foreach(column IN LISTS columns)
    string(REGEX MATCH "^([a-z_]+).([a-z0-9_]+)$" _ "${column}")
    set(table ${CMAKE_MATCH_1})
    set(name ${CMAKE_MATCH_2})
    set(found OFF)
    foreach(row IN LISTS rows)
      if(row MATCHES "^\\| `${table}` " AND row MATCHES "`${name}`")
        set(found ON)
      endif()
    endforeach()
    if(NOT found)
      message(FATAL_ERROR "fleet-database.md does not tell of ${table}.${name}")
    endif()
    math(EXPR told "${told} + 1")
  endforeach()
  if(told LESS 50)
    message(FATAL_ERROR "only ${told} columns in the database")
  endif()
endif()

run(3 ${HERE}/manifest.csv --out ${HERE}/broken --workers 2)
expect("${output}" "10 logs: 0 reports were there, 8 are new, 2 have none")
expect("${error}" "manifest.csv:10: [^\n]*broken.csv:3: column 'motor_C': 'x' is not a number")
expect("${error}" "manifest.csv:11: [^\n]*missing.csv: cannot be read")

# A log at which workers die costs itself alone: here one whose reading never ends, and whose worker is killed each time.
find_program(mkfifo mkfifo)
if(mkfifo)
  execute_process(COMMAND ${mkfifo} ${HERE}/logs/endless.csv)
  file(WRITE ${HERE}/endless.csv "${manifest}logs/endless.csv,model.json,9\n")
  execute_process(COMMAND sh -c "\"$0\" fleet \"$1\" --out \"$2\" --workers 1 2>\"$2.err\" & fleet=$!
                                 until [ $(ls \"$2\"/reports 2>/dev/null | grep -c json$) = 8 ]; do sleep 0.1; done
                                 while ps -o stat= -p $fleet | grep -q '^[^Z]'; do
                                   sleep 0.3
                                   worker=$(ps -o pid= --ppid $fleet) && kill -9 $worker
                                 done
                                 wait $fleet"
                          ${PROGRAM} ${HERE}/endless.csv ${HERE}/endless
                  RESULT_VARIABLE status OUTPUT_VARIABLE output TIMEOUT 300)
  file(READ ${HERE}/endless.err error)
  if(NOT status EQUAL 3)
    message(FATAL_ERROR "a log at which workers die: exit ${status}\n${output}${error}")
  endif()
  expect("${output}" "9 logs: 0 reports were there, 8 are new, 1 have none")
  expect("${error}" "endless.csv:10: its worker was killed twice")
endif()

# A manifest that is wrong is answered by its name and what is meant.
function(refused manifest answer)
  file(WRITE ${HERE}/wrong.csv "${manifest}")
  run(3 ${HERE}/wrong.csv --out ${HERE}/x)
  expect("${error}" "wrong.csv${answer}")
endfunction()
refused("log,modell\na,b\n" ":1: column 'modell'; expected log, model, unit, heldout, map or time")
refused("log,model,time\na,b,2026-13-01\n" ":2: column 'time': '2026-13-01'; expected a date")
refused("log,model\na,\"b\n\n" ":2: a quote that is never closed")
refused("log,model\na\n" ":2: 1 cells; expected 2")
refused("log,model\na,b\na,b\n" ":3: the same log as in line 2")
refused("log,model\n" ": no log in it")
