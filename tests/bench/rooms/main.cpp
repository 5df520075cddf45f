// Plays in sixteen rooms of four games while one of them burns a core, one crashes and one hangs repeatedly.
// Measures the effect on players of the other rooms, and the time of a move between rooms. Run by
// deploy/bench rooms.
//
//   naiad_rooms SECONDS   one line
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "GameProgram.h"
#include "Home.h"
#include "client/session/Connection.h"
#include "shared/values/SplitMix64.h"
#include "tests/bench/Guarded.h"
#include "tests/bench/Percentile.h"
#include "tests/support/Text.h"

namespace {

using Clock = std::chrono::steady_clock;
using bench::percentile;
using naiad::ClientSession;
using naiad::Connection;
using naiad::test::countIn;
using Millis = std::chrono::duration<double, std::milli>;

constexpr int kRooms = 16;
constexpr const char* kGames[] = {NAIAD_BINARY_DIR "/../lib/room_module.so", "hello", "chase", "tron"};
constexpr int kBurns = 0, kCrashes = 4, kHangs = 8;  ///< numbers of the failing rooms
constexpr std::chrono::microseconds kTick{33'333};
constexpr std::chrono::seconds kWarmUp{3};
constexpr std::chrono::milliseconds kBetweenMoves{700};
constexpr std::chrono::seconds kPatience{30};

std::string roomName(int number) {
  return "room-" + std::to_string(number);
}

bool isBad(int number) {
  return number == kBurns || number == kCrashes || number == kHangs;
}

/// A player that records the arrival times of its world's ticks.
class Player {
 public:
  Player(asio::io_context& context, std::uint16_t port, naiad::test::ClientSetup setup,
         const std::string& room)
      : m_connection(context, naiad::ServerAddress{"127.0.0.1", port}, inRoom(setup, room), true,
                     setup.trust) {
    m_connection.onSession([this](ClientSession& session) {
      session.onAfterSnapshot([this](const naiad::SnapshotHeader& header, const naiad::AckWindow&) {
        note(header, Clock::now());
      });
    });
    m_connection.start();
  }

  void update(Clock::time_point now) { m_connection.update(now); }
  bool plays() {
    return m_connection.session() != nullptr && m_connection.state() == Connection::State::kJoined;
  }
  ClientSession& session() { return *m_connection.session(); }
  void press(df::Keyboard::Key key) {
    session().sendKey(key, df::KEY_PRESSED, Clock::now());
    session().sendKey(key, df::KEY_RELEASED, Clock::now());
  }
  /// Starts recording `gaps`.
  void measure() {
    m_measures = true;
    gaps.clear();
  }
  /// True if the player has received the complete world of the newest snapshot.
  bool isComplete() const { return m_complete; }
  std::uint8_t epoch() const { return m_epoch; }

  /// Milliseconds between consecutive snapshots. If ticks without changes are between them, the length of
  /// these ticks is subtracted.
  std::vector<double> gaps;

 private:
  static naiad::SessionOptions inRoom(const naiad::test::ClientSetup& setup, const std::string& room) {
    naiad::SessionOptions options = setup.options;
    options.room = room;
    return options;
  }
  void note(const naiad::SnapshotHeader& header, Clock::time_point now) {
    const auto ticks = static_cast<std::int32_t>(header.tick - m_tick);
    const bool follows = header.epoch == m_epoch && ticks > 0;
    if (m_measures && follows) gaps.push_back(Millis(now - m_at - (ticks - 1) * kTick).count());
    if (header.epoch != m_epoch || header.complete) m_complete = header.complete;
    if (follows || header.epoch != m_epoch) {
      m_tick = header.tick;
      m_at = now;
    }
    m_epoch = header.epoch;
  }

  Connection m_connection;
  bool m_measures = false;
  bool m_complete = false;
  std::uint8_t m_epoch = 0;
  std::uint32_t m_tick = 0;
  Clock::time_point m_at{};
};

class Run {
 public:
  Run() {
    std::vector<std::string> arguments{"--room-sleep=3600"};
    for (int i = 0; i < kRooms; ++i) arguments.push_back("--room=" + roomName(i) + "=" + kGames[i % 4]);
    m_server = std::make_unique<naiad::test::GameProgram>(
        "dfserver", std::map<std::string, std::string>{{"NAIAD_FRAME_TIME", "0"}}, arguments);
    for (int i = 0; i < kRooms; ++i) join("player-" + std::to_string(i), roomName(i));
    join("traveller", roomName(1));
  }

  /// Runs the measurement. False if it was not possible.
  bool measure(std::chrono::seconds time) {
    if (!serveUntil(Clock::now() + kPatience, [&] {
          return std::all_of(m_players.begin(), m_players.end(),
                             [](auto& player) { return player->plays(); });
        }))
      return false;
    serveUntil(Clock::now() + kWarmUp, [] { return false; });
    m_players[kBurns]->press(df::Keyboard::B);
    for (int i = 0; i < kRooms; ++i) {
      if (!isBad(i)) m_players[i]->measure();
    }
    const auto end = Clock::now() + time;
    auto next_move = Clock::now();
    auto next_keys = Clock::now();
    serveUntil(end, [&] {
      const auto now = Clock::now();
      if (now >= next_keys) {
        playOn();
        next_keys = now + std::chrono::milliseconds(100);
      }
      if (!m_moving && now >= next_move) beginMove(now);
      if (m_moving && hasMoved()) {
        m_moves.push_back(Millis(now - m_move_began).count());
        m_moving = false;
        next_move = now + kBetweenMoves;
      }
      return false;
    });
    return true;
  }

  int report() {
    std::vector<double> gaps;
    double worst_p99 = 0;
    for (int i = 0; i < kRooms; ++i) {
      const std::vector<double>& of_room = m_players[i]->gaps;
      gaps.insert(gaps.end(), of_room.begin(), of_room.end());
      worst_p99 = std::max(worst_p99, percentile(of_room, 99));
    }
    const std::string log = m_server->log();
    const double frames = worst_p99 / Millis(kTick).count();
    const bool good = frames <= 2 && !m_moves.empty() && percentile(m_moves, 99) <= 300;
    std::printf(
        "rooms rooms=%d games=4 ticks=%zu gap_p50_ms=%.1f gap_p99_ms=%.1f worst_room_p99_ms=%.1f "
        "worst_room_p99_frames=%.2f gap_max_ms=%.1f moves=%zu move_p50_ms=%.1f move_p99_ms=%.1f crashed=%d "
        "hung=%d failed=%d\n",
        kRooms, gaps.size(), percentile(gaps, 50), percentile(gaps, 99), worst_p99, frames,
        percentile(gaps, 100), m_moves.size(), percentile(m_moves, 50), percentile(m_moves, 99),
        countIn(log, "crashed (SIGABRT)"), countIn(log, "did not answer"), good ? 0 : 1);
    return good ? 0 : 1;
  }

 private:
  void join(const std::string& name, const std::string& room) {
    m_players.push_back(std::make_unique<Player>(m_context, m_server->port(), m_home.player(name), room));
  }
  template <class Done>
  bool serveUntil(Clock::time_point end, Done done) {
    while (!done()) {
      const auto now = Clock::now();
      if (now > end) return false;
      for (const auto& player : m_players) player->update(now);
      m_context.restart();
      m_context.run_one_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  /// Presses keys so that something moves in each room, and makes the failing rooms fail again when they have
  /// recovered.
  void playOn() {
    constexpr df::Keyboard::Key kKeys[] = {df::Keyboard::LEFTARROW, df::Keyboard::RIGHTARROW,
                                           df::Keyboard::UPARROW, df::Keyboard::DOWNARROW};
    for (int i = 0; i < kRooms; ++i) {
      if (m_players[i]->plays() && !isBad(i)) m_players[i]->press(kKeys[m_random.below(4)]);
    }
    if (++m_turns % 20 == 0) m_players[kCrashes]->press(df::Keyboard::C);
    if (m_turns % 80 == 0) m_players[kHangs]->press(df::Keyboard::H);
  }
  void beginMove(Clock::time_point now) {
    Player& traveller = *m_players.back();
    do {
      m_target = static_cast<int>(m_random.below(kRooms));
    } while (isBad(m_target) || roomName(m_target) == traveller.session().welcome().room);
    m_epoch_before = traveller.epoch();
    m_move_began = now;
    m_moving = true;
    traveller.session().enterRoom(roomName(m_target));
  }
  bool hasMoved() {
    Player& traveller = *m_players.back();
    return traveller.session().welcome().room == roomName(m_target) && traveller.epoch() != m_epoch_before &&
           traveller.isComplete();
  }

  naiad::test::Home m_home;
  asio::io_context m_context;
  std::unique_ptr<naiad::test::GameProgram> m_server;
  std::vector<std::unique_ptr<Player>> m_players;  ///< indexed by room; the traveller is last
  naiad::SplitMix64 m_random{7};
  std::vector<double> m_moves;  ///< times of moves between rooms, in milliseconds
  bool m_moving = false;
  int m_target = 0;
  int m_turns = 0;
  std::uint8_t m_epoch_before = 0;
  Clock::time_point m_move_began{};
};

}  // namespace

int main(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 30;
  return bench::guarded("naiad_rooms", [seconds] {
    Run run;
    if (!run.measure(std::chrono::seconds(std::max(seconds, 1))))
      throw std::runtime_error("not all players got in");
    return run.report();
  });
}
