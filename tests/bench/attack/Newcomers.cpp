#include "Newcomers.h"

#include <algorithm>
#include <utility>

namespace bench::attack {

namespace {

using namespace std::chrono_literals;

constexpr int kNetwork = 90;
constexpr auto kRetryDelay = 250ms;  // of one that the server asks to wait, as dfclient's
constexpr auto kLeaveTime = 500ms;   // for the goodbye to get through

}  // namespace

void Newcomers::update(Time now) {
  if (now >= m_next) {
    m_next = std::max(m_next + 1s, now);
    m_guests.push_back({.address = addressIn(kNetwork, m_count++), .since = now, .next_attempt = now});
  }
  std::erase_if(m_guests, [&](Newcomer& newcomer) { return !serve(newcomer, now); });
}

// False if it is done with.
bool Newcomers::serve(Newcomer& newcomer, Time now) {
  const double waited = std::chrono::duration<double, std::milli>(now - newcomer.since).count();
  if (!newcomer.guest) {
    if (now < newcomer.next_attempt) return true;
    newcomer.guest = std::make_unique<Guest>(m_context, m_server.port, newcomer.address,
                                             guestOptions("new", m_server.password));
  }
  Guest& guest = *newcomer.guest;
  guest.update(now);
  if (newcomer.joined) return !guest.isOver() && now - newcomer.joined_at < kLeaveTime;
  if (guest.hasPicture(now)) {
    m_slowest_ms = std::max(m_slowest_ms, waited);
    newcomer.joined = true;
    newcomer.joined_at = now;
    guest.session()->leave();
    return true;
  }
  const bool in_time = now - newcomer.since < kPatience;
  if (in_time && !guest.isOver()) return true;
  if (in_time && guest.state() == Guest::State::kRefusedForNow) {
    newcomer.guest.reset();
    newcomer.next_attempt = now + kRetryDelay;
    return true;
  }
  ++m_failed;
  m_slowest_ms =
      std::max(m_slowest_ms, std::max<double>(waited, std::chrono::milliseconds(kPatience).count()));
  return false;
}

}  // namespace bench::attack
