// log_stall, log_gone: what reads the server's log stands still, or ends; players give it something to say.
#pragma once

#include <memory>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {

class LogReader : public Attack {
 public:
  enum class Fault { kStalls, kEnds };
  explicit LogReader(Fault fault) : m_fault(fault) {}

  void begin(const Target& target) override;
  void update(Time now) override;
  void end() override;

 private:
  Fault m_fault;
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  std::unique_ptr<Guest> m_guest;
  Time m_next{};
};

}  // namespace bench::attack
