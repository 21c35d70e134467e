/* SPDX-License-Identifier: MIT
   Copyright (c) 2026 the thermopower authors

   A short example; thermopower-gap design --c-array writes yours. An input holds its value until the next row:
   value = schedule_values[row][input] * schedule_unit[input]. Inputs, in their order: power_param. */
#pragma once
#include <stdint.h>
#ifdef __AVR__
#include <avr/pgmspace.h>
#endif
#ifndef PROGMEM
#define PROGMEM
#endif

enum { schedule_rows = 120, schedule_inputs = 1 };
static const float schedule_row_s = 1.0f;
static const char* const schedule_names[] = {"power_param"};
static const float schedule_unit[] = {6.10370190e-03f};
static const int16_t schedule_values[][1] PROGMEM = {
    {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767},
    {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767},
    {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767},
    {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {9830},  {9830},  {9830},  {9830},
    {9830},  {9830},  {9830},  {9830},  {9830},  {9830},  {9830},  {9830},  {9830},  {9830},  {9830},
    {9830},  {9830},  {9830},  {9830},  {9830},  {32767}, {32767}, {32767}, {32767}, {32767}, {32767},
    {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767}, {32767},
    {32767}, {32767}, {32767}, {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},
    {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},
    {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},
    {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0},     {0}};
