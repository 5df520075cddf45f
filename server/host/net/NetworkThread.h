// The server's sockets, on their own thread: accepting, TLS, frames, the gate for datagrams, sealing and
// opening, sendmmsg. The tick thread uses channels whose other ends are here (RelayedStream,
// RelayedDatagrams). It never waits for a socket, a handshake, or a lock held across a system call.
//
//   network thread   sockets -> Batch<Event>  --put--> Mailbox --take--> serve()   -> channels' callbacks
//   tick thread      channels -> Batch<Command>  --put--> Mailbox --take--> the sockets, in order
//
// Frames of streams wake the tick thread. Datagrams wait for its next tick, but keep their arrival time.
// Commands leave the tick thread with flush(): once per tick, and once for each serve() between ticks.
//
// Everything that passes between the threads is limited, and each loss is counted:
//   datagrams, each direction     dropped while the mailbox is full (Limits::mailbox)
//   a stream's frames             the stream ends (CloseReason::kOverflow) when more than Limits::stream_in
//                                 bytes of it wait for the tick thread, or its own queue (TcpOptions) or the
//                                 mailbox is full
//   connections                   dropped while Limits::unaccepted wait for the tick thread, or while the
//                                 mailbox is full
#pragma once

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "host/net/Mailbox.h"
#include "host/net/SealedChannel.h"
#include "host/net/ServerPort.h"
#include "host/net/TickTimes.h"
#include "shared/net/base/Channel.h"
#include "shared/net/datagram/UdpBatch.h"

namespace naiad {

class RelayedDatagrams;
class RelayedStream;

/// Data and connections that were lost between the threads. Each loss is counted once.
struct RelayCounters {
  std::uint64_t datagrams_in_dropped = 0;   ///< datagrams dropped because the tick thread was behind
  std::uint64_t datagrams_out_dropped = 0;  ///< datagrams dropped because the network thread was behind
  std::uint64_t streams_overflowed = 0;     ///< streams ended because too many of their frames waited
  std::uint64_t streams_clogged = 0;        ///< streams ended because their send queue was full
  std::uint64_t unaccepted = 0;             ///< connections dropped: too many waited for the tick thread
  std::uint64_t keyless = 0;                ///< keys requested from a stream that had ended
};

/// Traffic of streams (frames with their headers, before TLS) and of datagrams (UDP payloads).
struct TrafficCounters {
  std::uint64_t frames_in = 0;
  std::uint64_t frames_out = 0;
  std::uint64_t stream_bytes_in = 0;
  std::uint64_t stream_bytes_out = 0;
  std::uint64_t datagram_bytes_in = 0;
  std::uint64_t datagram_bytes_out = 0;
};

/// All counters of the network thread.
struct NetworkCounters {
  RelayCounters relay;
  TrafficCounters traffic;
  TcpListener::Counters streams;
  ProxyListener::Counters visitors;  ///< all zero without a visitors' socket
  DatagramDemuxCounters gate;        ///< all zero without datagrams, like `udp`
  UdpCounters udp;
};

class NetworkThread {
 public:
  using Clock = std::chrono::steady_clock;
  using OnChannel = TcpListener::OnChannel;

  struct Limits {
    std::size_t mailbox = std::size_t{32} << 20;  ///< bytes that may wait for each of the threads
    std::size_t stream_in = std::size_t{256}
                            << 10;  ///< bytes of one stream that may wait for the tick thread
    std::size_t unaccepted = 512;   ///< connections that may wait for the tick thread
  };

  /// Starts to listen (ServerPort.h); connections wait until start(). If there are `inherited` sockets, uses
  /// them and ignores `address` and `port`. `home` runs the tick thread's handlers, in which `on_channel` and
  /// the channels' callbacks are called. Throws ListenError.
  NetworkThread(asio::io_context& home, const std::string& address, std::uint16_t port, OnChannel on_channel,
                TcpOptions options, TlsListenerOptions tls, Limits limits, ProxyListenerOptions visitors = {},
                const std::optional<InheritedSockets>& inherited = std::nullopt);
  NetworkThread(asio::io_context& home, const std::string& address, std::uint16_t port, OnChannel on_channel,
                TcpOptions options, TlsListenerOptions tls)
      : NetworkThread(home, address, port, std::move(on_channel), options, std::move(tls), Limits{}) {}
  /// Channels must be destroyed before this; they may outlive the sockets.
  ~NetworkThread();

  // Call all of these on the tick thread, unless noted.

  void start();
  /// Ends the thread at once. Nothing is sent or received afterwards.
  void stop();
  /// Closes the listener at the next flush(), so that no new connections are accepted.
  void closeListener();
  /// Sets the certificate and key for connections accepted from now on.
  void setTls(std::shared_ptr<const TlsContext> context);

  /// Calls the callbacks for received messages until the time `enough`, but for at least a minimum number of
  /// messages. Returns false if it stopped at that time, so that messages may be left.
  bool serve(Clock::time_point enough);
  /// Passes everything that was sent since the last flush to the network thread.
  void flush() { sendCommands(std::nullopt); }
  /// Like flush(), at the end of a tick that began at `began`.
  void flushTick(Clock::time_point began) { sendCommands(began); }
  /// Returns when the message being served was received; outside serve(), the present time.
  Clock::time_point now() const { return m_serving ? m_received_at : Clock::now(); }

  /// True if there are datagrams in addition to streams.
  bool hasDatagrams() const { return m_port.datagrams != nullptr; }
  /// Opens datagrams for a session, with keys from `stream`, which must be one of this object's. Null if
  /// the server has no datagrams.
  std::unique_ptr<SealedChannel> openDatagrams(const ReliableChannel& stream, AeadId aead);

  std::uint16_t port() const { return m_port.streams->port(); }
  std::string address() const { return m_port.streams->address(); }

  /// Sends `frame` on all streams, closes them, and waits until all is sent, at most `timeout`. Call from
  /// any thread but the network thread, while that runs. Used if the tick thread hangs.
  void broadcastAndClose(const std::string& frame, std::chrono::milliseconds timeout);

  /// Durations of ticks, from their start to the last datagram sent. Thread-safe.
  const TickTimes& tickTimes() const { return m_tick_times; }
  /// Counters of the gate after the network thread's last turn; all zero without datagrams. Thread-safe.
  DatagramDemuxCounters gateCounters() const;
  void resetTickTimes() { m_tick_times.reset(); }
  /// Makes the network thread copy its counters after the next flush(); latestCounters() then returns them.
  void requestCounters() { postCommand({.kind = Command::kReportCounters}); }
  /// The counters of the last request, zero before the first, or of stop(); those of the tick thread are the
  /// present ones.
  NetworkCounters latestCounters() const;
  /// CPU time used by the network thread; 0 while it does not run.
  std::chrono::nanoseconds cpuTime();
  /// Call this only while the network thread does not run.
  RelayCounters counters() const;

 private:
  friend class RelayedDatagrams;
  friend class RelayedStream;

  /// The network thread's end of a stream. Non-atomic members belong to that thread.
  struct NetworkSideStream {
    std::uint64_t id = 0;
    std::string peer;  ///< never changes
    std::unique_ptr<ReliableChannel> channel;
    bool busy = false;                     ///< true if it is in m_busy
    std::atomic<std::size_t> unsent = 0;   ///< bytes taken over from the tick thread and not sent yet
    std::atomic<std::uint64_t> taken = 0;  ///< total bytes taken over from the tick thread
    std::atomic<std::size_t> in = 0;       ///< bytes in transit to the tick thread
  };
  /// The network thread's end of a session's datagrams.
  struct NetworkSideDatagrams {
    std::uint64_t id = 0;
    std::uint32_t slot = 0;  ///< index in m_datagram_slots
    std::uint64_t connection = 0;
    AeadId aead = AeadId::kAes128Gcm;
    std::unique_ptr<DatagramService::Channel> channel;  ///< null without keys
    std::atomic<std::int32_t> payload_budget = -1;      ///< SealedChannel::payloadBudget(); negative: nullopt
  };
  /// A message from the network thread.
  struct Event {
    enum Kind : std::uint8_t { kAccepted, kFrame, kClosed, kDatagram } kind = kAccepted;
    CloseReason reason = CloseReason::kLocal;
    std::uint32_t slot = 0;  ///< slot of the datagrams
    std::uint64_t id = 0;
    NetworkSideStream* stream = nullptr;
    Clock::time_point received_at{};
  };
  /// A message from the tick thread.
  struct Command {
    enum Kind : std::uint8_t {
      kSendFrame,
      kClose,
      kCut,
      kReceiveLimit,
      kDropStream,
      kOpenDatagrams,
      kRenew,
      kSendDatagram,
      kDropDatagrams,
      kCloseListener,
      kTickEnd,
      kReportCounters,
    } kind = kSendFrame;
    NetworkSideStream* stream = nullptr;
    NetworkSideDatagrams* datagrams = nullptr;
    std::uint64_t number = 0;  ///< the limit, the epoch, or the time when the tick began
  };

  // Members used on the tick thread; wakeHome() also on the network thread.
  bool renewDatagrams(NetworkSideDatagrams& end, const ReliableChannel& stream, Epoch epoch);
  void postCommand(const Command& order, std::string_view bytes = {}) { m_commands.add(order, bytes); }
  bool isCommandMailboxFull() const {
    return m_command_mailbox.size() + m_commands.size() > m_limits.mailbox;
  }
  void sendCommands(std::optional<Clock::time_point> tick_began);
  void onEvent(const Event& notice, std::string_view bytes);
  void wakeHome();

  // Members used on the network thread.
  void run();
  void runCommands();
  void runCommand(const Command& order, std::string_view bytes);
  void endIteration();
  void registerStream(std::unique_ptr<ReliableChannel> channel);
  void onFrame(NetworkSideStream& end, std::string_view frame);
  void onClosed(NetworkSideStream& end, CloseReason reason);
  void openDatagrams(NetworkSideDatagrams& end, const NetworkSideStream& stream);
  void updatePayloadBudget(NetworkSideDatagrams& end);
  bool hasUnsent() const;
  void addEvent(const Event& notice, std::string_view bytes = {});
  bool isEventMailboxFull() const { return m_event_mailbox.size() + m_events.size() > m_limits.mailbox; }
  void updateUnsent();
  void reportCounters();

  asio::io_context& m_home;
  OnChannel m_on_channel;
  Limits m_limits;

  // Owned by the network thread.
  asio::io_context m_io{1};
  asio::executor_work_guard<asio::io_context::executor_type> m_work{m_io.get_executor()};
  ServerPort m_port;
  std::unordered_map<const NetworkSideStream*, std::unique_ptr<NetworkSideStream>> m_streams;
  std::unordered_map<const NetworkSideDatagrams*, std::unique_ptr<NetworkSideDatagrams>> m_datagrams;
  std::vector<NetworkSideStream*> m_busy;  ///< streams that may have unsent bytes
  Clock::time_point m_count_at{};          ///< earliest time of the next count
  Batch<Command> m_running_commands;
  Batch<Event> m_events;
  std::uint64_t m_newest_stream = 0;
  bool m_urgent = false;  ///< true if the tick thread must be woken for m_events
  RelayCounters m_counters;
  TrafficCounters m_traffic;

  // Shared by both threads.
  Mailbox<Event> m_event_mailbox;
  Mailbox<Command> m_command_mailbox;
  std::atomic<bool> m_home_woken = false;
  std::atomic<bool> m_woken = false;
  std::atomic<bool> m_stopping = false;
  std::atomic<std::size_t> m_unaccepted = 0;
  TickTimes m_tick_times;
  mutable std::mutex m_gate_mutex;
  DatagramDemuxCounters m_gate_counters;  ///< a copy, for other threads
  NetworkCounters m_reported;             ///< counters of the last request

  // Owned by the tick thread.
  Batch<Command> m_commands;
  Batch<Event> m_serving_batch;
  std::unordered_map<std::uint64_t, RelayedStream*> m_relayed_streams;
  /// A slot is reused, but no id is, so an event in transit when its session ends reaches no channel.
  struct DatagramSlot {
    std::uint64_t id = 0;
    RelayedDatagrams* channel = nullptr;
  };
  std::vector<DatagramSlot> m_datagram_slots;
  std::vector<std::uint32_t> m_free_slots;
  std::uint64_t m_newest_datagrams = 0;
  bool m_serving = false;
  Clock::time_point m_received_at{};
  std::uint64_t m_out_dropped = 0;
  std::uint64_t m_clogged = 0;

  std::thread m_thread;
};

}  // namespace naiad
