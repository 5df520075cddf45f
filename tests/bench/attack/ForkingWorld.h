// fork300: a game in a process of its own forks 300 children. Which of them outlive their world?
#pragma once

#include <cstddef>
#include <memory>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {

class ForkingWorld : public Attack {
 public:
  /// From now on this process inherits those whose parents end, so that none is lost sight of.
  ForkingWorld();

  ServerSetup setup() const override;
  void begin(const Target& target) override;
  void update(Time now) override;
  void end() override;
  void addFindings(Findings& findings) override;

 private:
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  std::unique_ptr<Guest> m_guest;
  bool m_asked = false;
  bool m_left = false;
  bool m_counted = false;
  Time m_leave_at{};
  Time m_count_at{};
  std::chrono::milliseconds m_patience{0};
  std::size_t m_forked = 0;
  std::size_t m_after_world = 0;
};

}  // namespace bench::attack
