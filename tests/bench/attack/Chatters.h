// chat_detached: players who say as much as they may, all the time.
#pragma once

#include <memory>
#include <vector>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {

class Chatters : public Attack {
 public:
  explicit Chatters(int count) : m_count(count) {}

  void begin(const Target& target) override;
  void update(Time now) override;
  void end() override;
  void addFindings(Findings& findings) override;

 private:
  int m_count;
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  std::vector<std::unique_ptr<Guest>> m_guests;
  Time m_next_line{};
  long long m_ended = 0;  ///< chatters whose session ended
};

}  // namespace bench::attack
