// Answers clients that look for the servers of the local network (LanMessage.h).
//
// It has a thread and sockets of its own, so that whatever is sent there costs the game nothing but processor
// time, and little of that: no more than kTurn packets are read in kPause; the system drops the rest.
// Networks that come and go are noticed within kRefresh.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "host/net/LanQueryJudge.h"

namespace naiad {

class LanResponder {
 public:
  static constexpr int kTurn = 64;  ///< packets, of each family
  static constexpr std::chrono::milliseconds kPause{50};
  static constexpr std::chrono::seconds kRefresh{5};

  /// Opens the sockets. Throws std::system_error if there is none of either family. `facts`: all but nonce
  /// and players. `address`: numeric, that the server listens on.
  LanResponder(LanAnswer facts, std::string address, LanMode mode);
  /// Stops.
  ~LanResponder();
  LanResponder(const LanResponder&) = delete;
  LanResponder& operator=(const LanResponder&) = delete;

  void start();
  /// End the thread. Nothing is answered after that.
  void stop();

  /// How many play. From any thread.
  void setPlayers(std::size_t players) { m_players.store(players, std::memory_order_relaxed); }
  /// Before start() or after stop().
  const LanCounters& counters() const { return m_judge.counters(); }

 private:
  void run();
  void refresh();
  bool serve(LanSocket& socket);
  void wait(bool sockets, std::chrono::milliseconds time);

  std::string m_address;
  LanMode m_mode;
  LanQueryJudge m_judge;
  std::vector<LanSocket> m_sockets;
  std::atomic<std::size_t> m_players = 0;
  std::atomic<bool> m_stopping = false;
  int m_wake = -1;  ///< an eventfd: written to stop
  std::thread m_thread;
};

}  // namespace naiad
