// Attacks by guests that do what clients may do, but too often: chatters, held slots, noise for the log,
// password guesses, and players that do nothing.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {
using namespace std::chrono_literals;
using Millis = std::chrono::milliseconds;

/// Numbers of guests.
struct Counts {
  double invited = 0;
  double killed = 0;   ///< killed by the attack, in the game
  double ended = 0;    ///< ended in any other way
  double refused = 0;  ///< refused for good
  double busy = 0;     ///< told to retry
  double lost = 0;     ///< disconnected
  double most = 0;     ///< maximum in the game at once
};

/// A crowd of guests. Each is invited again some time after its end.
struct Plan {
  std::string name{};
  std::string password{};
  std::size_t guests = 1;
  std::function<std::string(int n)> address{};
  Millis pause{};          ///< time from a guest's end to the next invitation
  Millis pause_if_busy{};  ///< after it was told to retry; 0: like `pause`
  Millis stagger{};        ///< between the first invitations of two guests
  ServerSetup setup{};
  std::chrono::seconds lead{};
  /// Called repeatedly while a guest is in the game. True if it is killed now. `next` is the guest's own.
  std::function<bool(Guest& guest, Time now, Time& next)> play{};
  std::vector<std::pair<const char*, double Counts::*>> figures{};
  bool must_be_complete = false;  ///< the first figure is a fault if the guests are never all in the game
};

class Crowd : public Attack {
 public:
  explicit Crowd(const Plan& plan) : m_plan(plan), m_seats(plan.guests) {}

  ServerSetup setup() const override { return m_plan.setup; }
  std::chrono::seconds leadTime() const override { return m_plan.lead; }
  void begin(const Target& target) override {
    m_p_context = &target.context;
    m_port = target.server.port();
    Time next = std::chrono::steady_clock::now();
    for (Seat& seat : m_seats) seat.next = std::exchange(next, next + m_plan.stagger);
  }
  void update(Time now) override {
    double playing = 0;
    for (std::size_t i = 0; i < m_seats.size(); ++i) {
      Seat& seat = m_seats[i];
      if (!seat.guest) {
        if (now < seat.next) continue;
        seat.guest = std::make_unique<Guest>(*m_p_context, m_port, m_plan.address(static_cast<int>(i)),
                                             m_plan.name, m_plan.password);
        ++m_counts.invited;
      }
      seat.guest->update(now);
      const Guest::State state = seat.guest->state();
      playing += state == Guest::State::kPlaying ? 1 : 0;
      const bool killed =
          state == Guest::State::kPlaying && m_plan.play && m_plan.play(*seat.guest, now, seat.next);
      if (!killed && !seat.guest->isOver()) continue;
      const bool is_busy = state == Guest::State::kRefusedForNow;
      ++(killed ? m_counts.killed : m_counts.ended);
      m_counts.refused += state == Guest::State::kRefused ? 1 : 0;
      m_counts.busy += is_busy ? 1 : 0;
      m_counts.lost += state == Guest::State::kLost ? 1 : 0;
      seat.guest.reset();
      seat.next = now + (is_busy && m_plan.pause_if_busy > 0ms ? m_plan.pause_if_busy : m_plan.pause);
    }
    m_counts.most = std::max(m_counts.most, playing);
  }
  void end() override { m_seats.clear(); }
  void addFigures(Figures& figures) override {
    for (const auto& [key, count] : m_plan.figures) figures.push_back({key, m_counts.*count});
    if (m_plan.must_be_complete && m_counts.most < static_cast<double>(m_plan.guests))
      figures.front().is_fault = true;
  }

 private:
  struct Seat {
    std::unique_ptr<Guest> guest;
    Time next{};
  };
  const Plan m_plan;
  std::vector<Seat> m_seats;
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  Counts m_counts;
};

/// A crowd, while the reader of the log stalls or exits.
class LogReader : public Crowd {
 public:
  LogReader(const Plan& plan, bool stalls) : Crowd(plan), m_stalls(stalls) {}
  void begin(const Target& target) override {
    Crowd::begin(target);
    m_stalls ? target.server.stallLog() : target.server.closeLog();
  }

 private:
  bool m_stalls;
};

inline auto in(int network) {
  return [network](int n) { return addressIn(network, n); };
}

inline std::string addressOfNetwork(int n) {
  return "127." + std::to_string(100 + n / 250) + "." + std::to_string(n % 250) + ".1";
}

/// Sends a line every 125 ms: more than twice the allowed rate.
inline bool chat(Guest& guest, Time now, Time& next) {
  if (now < next) return false;
  next = now + 125ms;
  guest.session()->sendChat(longLine());
  return false;
}

inline bool killAtOnce(Guest& /*guest*/, Time /*now*/, Time& /*next*/) {
  return true;
}

inline bool leave(Guest& guest, Time /*now*/, Time& /*next*/) {
  guest.session()->leave();
  return false;
}

inline AttackPtr makeChatters(std::size_t count) {
  return std::make_unique<Crowd>(
      Plan{.name = "talker",
           .guests = count,
           .address = in(5),
           .pause = 125ms,
           .play = chat,
           .figures = {{"chatters", &Counts::most}, {"chatters_ended", &Counts::ended}}});
}

inline AttackPtr makeHeldPlaces() {
  return std::make_unique<Crowd>(
      Plan{.name = kHeldName,
           .address = in(6),
           .pause = 300ms,
           .setup = {.arguments = {"--max-players", "10", "--max-per-address", std::to_string(kHeldAllowed)},
                     .password = {}},
           .play = killAtOnce,
           .figures = {{"joins", &Counts::killed}, {"joins_refused", &Counts::ended}}});
}

// The server logs a line each time the guest joins or leaves.
inline AttackPtr makeLogReader(bool stalls) {
  return std::make_unique<LogReader>(Plan{.name = "noise", .address = in(8), .pause = 170ms, .play = leave},
                                     stalls);
}

inline AttackPtr makePasswordCrowd() {
  return std::make_unique<Crowd>(Plan{.name = "guesser",
                                      .password = "a wrong one",
                                      .guests = 80,
                                      .address = in(7),
                                      .pause = 500ms,
                                      .pause_if_busy = 300ms,
                                      .setup = {.arguments = {}, .password = "the right one"},
                                      .figures = {{"guesses", &Counts::refused}, {"busy", &Counts::busy}}});
}

// The honest players have the other three places.
inline AttackPtr makeIdleCrowd() {
  return std::make_unique<Crowd>(Plan{.name = "idler",
                                      .guests = 61,
                                      .address = [](int) { return addressIn(11, 0); },
                                      .pause = 1s,
                                      .lead = 75s,
                                      .figures = {{"crowd", &Counts::most}, {"removed", &Counts::lost}},
                                      .must_be_complete = true});
}

inline AttackPtr makeKnockingNetworks() {
  return std::make_unique<Crowd>(
      Plan{.name = "guesser",
           .password = "a wrong one",
           .guests = 2000,
           .address = addressOfNetwork,
           .pause = 60s,
           .stagger = 30ms,
           .setup = {.arguments = {}, .password = "the right one"},
           .figures = {{"knocks", &Counts::invited}, {"guesses", &Counts::refused}}});
}

}  // namespace bench::attack
