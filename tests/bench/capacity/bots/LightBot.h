// A player who sees nothing: logs in, acknowledges every snapshot, presses keys. As little work for the
// machine as that can be, so that thousands fit on a core.
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

/// Where the server is, and what all bots share.
struct Harbour {
  asio::io_context& context;
  std::shared_ptr<const naiad::TlsContext> tls;
  std::string host;
  std::uint16_t port = 0;
};

/// "127.x.y.z", another one for each bot.
std::string addressOf(int index);

/// Not thread-safe.
class LightBot {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kInputEvery{200};
  static constexpr int kTurnsOneIn = 16;  ///< inputs: the others press the same key again

  LightBot(const Harbour& harbour, int index);
  ~LightBot();

  /// Begin to log in.
  void start();
  /// Snapshots come as datagrams.
  bool isReady() const { return m_ready; }
  /// It was refused or thrown out.
  bool isOver() const { return m_over; }
  /// Its socket; -1 before it has been let in.
  int descriptor() const { return m_descriptor; }
  /// "127.0.0.2:40000".
  std::string endpoint() const;
  /// Something may have come. Bytes of the datagram; 0: nothing.
  std::size_t receive(Time now);
  /// Take what comes and answer nothing.
  void sink() { m_sinking = true; }
  /// Probe while no datagram has come. Now and then.
  void update(Time now);

  /// Since resetFigures().
  std::uint64_t received = 0;
  std::uint64_t bytes = 0;
  /// Snapshots that were sent and never came.
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
  std::vector<naiad::Input> m_inputs;  ///< that the server has not taken in
  std::uint32_t m_newest_input = 0;
  Time m_next_input{};
  Time m_probed{};
  naiad::SplitMix64 m_random;
  bool m_left = false;
  std::uint32_t m_first = 0;  ///< snapshot since resetFigures()
  std::uint64_t m_snapshots = 0;
};

}  // namespace bench::capacity
