// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#include "simulated_chip.hpp"

#include <avr_adc.h>
#include <avr_eeprom.h>
#include <avr_uart.h>
#include <sim_avr.h>
#include <sim_elf.h>

#include <cstring>
#include <deque>
#include <stdexcept>

namespace nano {
namespace {

constexpr std::uint8_t paint = 0xC5;

void log_nothing(avr_t*, const int, const char*, va_list) {}

}  // namespace

struct SimulatedChip::Simulation {
  struct Arrival {
    std::uint64_t end_cycle;
    std::uint8_t byte;
  };

  std::string path;
  ElfFacts elf;
  avr_t* avr = nullptr;
  avr_uart_t* uart = nullptr;
  SimulatedChip* owner = nullptr;
  std::deque<Arrival> arrivals;    // not yet on the pin
  std::deque<std::uint64_t> seen;  // given to simavr, not yet reported as received
  bool is_arrival_timed = false;
  std::uint64_t overruns = 0;

  ~Simulation() {
    if (avr != nullptr) {
      avr_terminate(avr);
      std::free(avr);
    }
  }

  // simavr makes a byte visible one byte time after it was given, so it is given that long before its stop
  // bit ends.
  static avr_cycle_count_t arrive(avr_t* avr, avr_cycle_count_t, void* self_pointer) {
    auto& self = *static_cast<Simulation*>(self_pointer);
    while (!self.arrivals.empty() && self.arrivals.front().end_cycle <= avr->cycle + cycles_per_byte) {
      const Arrival arrival = self.arrivals.front();
      self.arrivals.pop_front();
      const unsigned waiting = (self.uart->input.write - self.uart->input.read + 64u) % 64u;
      if (waiting >= 2) {
        ++self.overruns;
      } else {
        avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), arrival.byte);
        self.seen.push_back(avr->cycle + cycles_per_byte);
      }
    }
    self.is_arrival_timed = !self.arrivals.empty();
    return self.is_arrival_timed ? self.arrivals.front().end_cycle - cycles_per_byte : 0;
  }

  static avr_cycle_count_t pause(avr_t*, avr_cycle_count_t, void*) { return 0; }

  static void transmit(avr_irq_t*, std::uint32_t value, void* self_pointer) {
    auto& self = *static_cast<Simulation*>(self_pointer);
    if (self.owner->on_transmit) self.owner->on_transmit(self.avr->cycle, static_cast<std::uint8_t>(value));
  }

  void run_once() {
    avr_run(avr);
    // The program sets the baud rate at some time; simavr then counts 11 bits for 10.
    uart->cycles_per_byte = cycles_per_byte;
    while (!seen.empty() && avr->cycle >= seen.front()) {
      if (owner->on_received) owner->on_received(seen.front());
      seen.pop_front();
    }
  }
};

SimulatedChip::SimulatedChip(const std::string& elf_path) : simulation_(std::make_unique<Simulation>()) {
  Simulation& self = *simulation_;
  self.path = elf_path;
  self.elf = ElfFacts::read(elf_path);
  avr_global_logger_set(log_nothing);
  elf_firmware_t firmware;
  std::memset(&firmware, 0, sizeof firmware);
  if (elf_read_firmware(elf_path.c_str(), &firmware) != 0)
    throw std::runtime_error(elf_path + ": simavr cannot load this program");
  self.avr = avr_make_mcu_by_name("atmega328p");
  if (self.avr == nullptr) throw std::runtime_error("this libsimavr knows no atmega328p");
  avr_init(self.avr);
  self.avr->frequency = 16000000;
  self.avr->vcc = self.avr->avcc = self.avr->aref = 5000;
  self.avr->log = LOG_NONE;
  self.avr->sleep = [](avr_t*, avr_cycle_count_t) {};
  avr_load_firmware(self.avr, &firmware);
  for (avr_io_t* part = self.avr->io_port; part != nullptr; part = part->next)
    if (std::strcmp(part->kind, "uart") == 0) self.uart = reinterpret_cast<avr_uart_t*>(part);
  if (self.uart == nullptr) throw std::runtime_error("this libsimavr's atmega328p has no serial port");
  std::uint32_t no_flags = 0;
  avr_ioctl(self.avr, AVR_IOCTL_UART_SET_FLAGS('0'), &no_flags);
  avr_irq_register_notify(avr_io_getirq(self.avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
                          Simulation::transmit, &self);
  const std::uint32_t first_free = 0x100 + self.elf.static_ram_bytes;
  std::memset(self.avr->data + first_free, paint, self.avr->ramend + 1u - first_free);
  self.owner = this;
}

SimulatedChip::~SimulatedChip() = default;
SimulatedChip::SimulatedChip(SimulatedChip&& other) noexcept
    : on_transmit(std::move(other.on_transmit)),
      on_received(std::move(other.on_received)),
      simulation_(std::move(other.simulation_)) {
  simulation_->owner = this;
}
SimulatedChip& SimulatedChip::operator=(SimulatedChip&& other) noexcept {
  on_transmit = std::move(other.on_transmit);
  on_received = std::move(other.on_received);
  simulation_ = std::move(other.simulation_);
  simulation_->owner = this;
  return *this;
}

bool SimulatedChip::run_until_or_stop(std::uint64_t cycle) {
  Simulation& self = *simulation_;
  self.avr->run_cycle_limit = 1u << 20;
  if (cycle > self.avr->cycle)
    avr_cycle_timer_register(self.avr, cycle - self.avr->cycle, Simulation::pause, &self);
  while (self.avr->cycle < cycle) {
    self.run_once();
    if (self.avr->state == cpu_Crashed)
      throw std::runtime_error(self.path + ": the program crashed at program address " +
                               std::to_string(self.avr->pc) + ", cycle " + std::to_string(self.avr->cycle));
    if (self.avr->state == cpu_Done) return false;
  }
  return true;
}

void SimulatedChip::run_until(std::uint64_t cycle) {
  if (!run_until_or_stop(cycle))
    throw std::runtime_error(simulation_->path + ": the program stopped itself at cycle " +
                             std::to_string(this->cycle()));
}

void SimulatedChip::run_instruction() {
  simulation_->avr->run_cycle_limit = 1;
  simulation_->avr->run_cycle_count = 1;
  simulation_->run_once();
}

void SimulatedChip::receive(std::uint64_t end_cycle, std::uint8_t byte) {
  Simulation& self = *simulation_;
  self.arrivals.push_back({end_cycle, byte});
  if (self.is_arrival_timed) return;
  const std::uint64_t now = self.avr->cycle;
  const std::uint64_t given = end_cycle > now + cycles_per_byte ? end_cycle - cycles_per_byte - now : 1;
  avr_cycle_timer_register(self.avr, given, Simulation::arrive, &self);
  self.is_arrival_timed = true;
}

std::uint64_t SimulatedChip::cycle() const { return simulation_->avr->cycle; }
std::uint8_t SimulatedChip::data(std::uint16_t address) const { return simulation_->avr->data[address]; }
void SimulatedChip::set_data(std::uint16_t address, std::uint8_t value) {
  simulation_->avr->data[address] = value;
}
void SimulatedChip::set_eeprom(std::uint16_t address, std::uint8_t value) {
  avr_eeprom_desc_t byte = {&value, address, 1};
  avr_ioctl(simulation_->avr, AVR_IOCTL_EEPROM_SET, &byte);
}
void SimulatedChip::set_analog(int channel, std::uint32_t mV) {
  avr_raise_irq(avr_io_getirq(simulation_->avr, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + channel), mV);
}
void SimulatedChip::reset(bool is_power_lost) {
  Simulation& self = *simulation_;
  if (is_power_lost)
    for (std::uint32_t address = 0x100; address <= self.avr->ramend; ++address)
      self.avr->data[address] = static_cast<std::uint8_t>(0xA5u ^ (address * 37u));
  avr_reset(self.avr);
  self.uart->cycles_per_byte = cycles_per_byte;
  self.arrivals.clear();
  self.seen.clear();
  self.is_arrival_timed = false;
}
const ElfFacts& SimulatedChip::elf() const { return simulation_->elf; }
std::uint64_t SimulatedChip::bytes_overrun() const { return simulation_->overruns; }

std::uint16_t SimulatedChip::deepest_stack_bytes() const {
  const Simulation& self = *simulation_;
  std::uint32_t address = 0x100 + self.elf.static_ram_bytes;
  while (address <= self.avr->ramend && self.avr->data[address] == paint) ++address;
  return static_cast<std::uint16_t>(self.avr->ramend + 1u - address);
}

}  // namespace nano
