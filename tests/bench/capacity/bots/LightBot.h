// A player without a picture: logs in, acknowledges every snapshot and presses keys. This is so little work
// that one core can run thousands of them.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shared/net/datagram/SealedLink.h"
#include "shared/net/stream/TcpConnector.h"
#include "shared/replica/Acks.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/SplitMix64.h"

namespace bench::capacity {

/// Address of the server, and objects that all bots share.
struct Harbour {
  asio::io_context& context;
  std::shared_ptr<const naiad::TlsContext> tls;
  std::string host;
  std::uint16_t port = 0;
};

/// Returns "127.x.y.z", different for each bot.
std::string addressOf(int index);

/// Not thread-safe.
class LightBot {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kInputEvery{200};
  static constexpr int kTurnsOneIn = 16;  ///< one in this number of inputs changes the direction

  LightBot(const Harbour& harbour, int index);
  ~LightBot();

  /// Begins to log in.
  void start();
  /// True if the bot receives snapshots as datagrams.
  bool isReady() const { return m_ready; }
  /// True if the bot was refused or disconnected.
  bool isOver() const { return m_over; }
  /// Returns the descriptor of the bot's UDP socket; -1 before it has joined.
  int descriptor() const { return m_descriptor; }
  /// Returns the bot's address and port, for example "127.0.0.2:40000".
  std::string endpoint() const;
  /// Receives a datagram if one has arrived. Returns its size; 0 if none has.
  std::size_t receive(Time now);
  /// Receives datagrams from now on without answering.
  void sink() { m_sinking = true; }
  /// Sends a probe while no datagram has arrived. Call from time to time.
  void update(Time now);

  /// Numbers of datagrams and bytes received since resetFigures().
  std::uint64_t received = 0;
  std::uint64_t bytes = 0;
  /// Returns the number of snapshots that were sent but did not arrive.
  std::uint64_t missing() const;
  void resetFigures();

 private:
  void onFrame(std::string_view frame);
  void openSocket();
  void takeSnapshot(std::string_view bytes, Time now);
  void press(Time now);
  void answer(Time now);

  Harbour m_harbour;
  int m_index;
  std::optional<naiad::TcpConnector> m_connector;
  std::unique_ptr<naiad::ReliableChannel> m_channel;
  std::unique_ptr<naiad::SealedLink> m_link;
  int m_descriptor = -1;
  bool m_ready = false;
  bool m_over = false;
  bool m_sinking = false;
  naiad::AckWindow m_acks;
  naiad::SnapshotContext m_context;
  std::vector<naiad::Input> m_inputs;  ///< inputs that the server has not confirmed
  std::uint32_t m_newest_input = 0;
  Time m_next_input{};
  Time m_probed{};
  naiad::SplitMix64 m_random;
  bool m_left = false;
  std::uint32_t m_first = 0;  ///< number of the first snapshot since resetFigures()
  std::uint64_t m_snapshots = 0;
};

}  // namespace bench::capacity
