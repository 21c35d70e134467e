# SPDX-License-Identifier: MIT
# Copyright (c) 2026 the thermopower authors

# Fails where a page of the documentation would ask another host for something. Links that people follow are no requests.
#   cmake -DPAGES=<folder> -P docs_requests.cmake
file(GLOB pages ${PAGES}/*.html ${PAGES}/*.css ${PAGES}/katex/*.css)
if(NOT pages)
  message(FATAL_ERROR "thermopower: no pages in ${PAGES}")
endif()
foreach(page IN LISTS pages)
  file(READ ${page} text)
  string(REGEX MATCH "(<(script|img|iframe|object|embed|source|video|audio)[^>]*[ \t](src|data)=[\"']?(https?:)?//[^\"' >]*|<link[^>]*[ \t]href=[\"']?(https?:)?//[^\"' >]*|url\\([\"']?(https?:)?//[^)]*|@import[^;]*//[^;]*)"
         request "${text}")
  if(request)
    message(FATAL_ERROR "thermopower: ${page} asks another host: ${request}")
  endif()
endforeach()
