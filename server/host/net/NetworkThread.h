// The server's sockets, on a thread of their own: accepting, TLS, frames, the gate for datagrams, opening and
// sealing, sendmmsg. The thread that ticks knows channels whose other ends are here (RelayedStream,
// RelayedDatagrams), and never waits for a socket, a handshake, or a lock that is held across a system call.
//
//   network thread   sockets -> Batch<Notice>  --put--> Mailbox --take--> serve()   -> channels' callbacks
//   tick thread      channels -> Batch<Order>  --put--> Mailbox --take--> the sockets, in order
//
// Streams' frames wake the tick thread; datagrams wait for its next tick, which is when they count, with the
// time at which they came. Orders leave the tick thread with flush(): once for a tick, once for what was
// served between two.
//
// Everything here is bounded, and what is over a bound is counted:
//   datagrams, each direction     dropped while the mailbox is full (Limits::mailbox)
//   a stream's frames             the stream ends (CloseReason::kOverflow) when more than Limits::stream_in
//                                 bytes of it wait for the tick thread, or its own queue (TcpOptions) or the
//                                 mailbox is full
//   connections                   hung up on while Limits::unmet wait for the tick thread
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

/// What did not get across, each once.
struct RelayCounters {
  std::uint64_t datagrams_in_dropped = 0;   ///< the tick thread was behind
  std::uint64_t datagrams_out_dropped = 0;  ///< the network thread was behind
  std::uint64_t streams_overflowed = 0;     ///< ended: more frames than the tick thread could take
  std::uint64_t streams_clogged = 0;        ///< ended: more to send than its queue holds
  std::uint64_t unmet = 0;                  ///< connections hung up on: too many waited to be met
  std::uint64_t keyless = 0;                ///< sessions whose stream ended before it could give keys
};

/// What came and went. Of streams: frames with their heads, before TLS; of datagrams: payloads of UDP.
struct TrafficCounters {
  std::uint64_t frames_in = 0;
  std::uint64_t frames_out = 0;
  std::uint64_t stream_bytes_in = 0;
  std::uint64_t stream_bytes_out = 0;
  std::uint64_t datagram_bytes_in = 0;
  std::uint64_t datagram_bytes_out = 0;
};

/// All that the network thread counts.
struct NetworkCounters {
  RelayCounters relay;
  TrafficCounters traffic;
  TcpListener::Counters streams;
  VisitorsListener::Counters visitors;  ///< all zero without a visitors' socket
  DatagramGateCounters gate;            ///< all zero without datagrams, as the next
  UdpCounters udp;
};

class NetworkThread {
 public:
  using Clock = std::chrono::steady_clock;
  using OnChannel = TcpListener::OnChannel;

  struct Limits {
    std::size_t mailbox = std::size_t{32} << 20;  ///< bytes that may wait for one of the threads
    std::size_t stream_in = std::size_t{256}
                            << 10;  ///< bytes of one stream that may wait for the tick thread
    std::size_t unmet = 512;        ///< connections that it has not met yet
  };

  /// Listens from now on (ServerPort.h), with the `inherited` sockets if there are any, whatever `address`
  /// and `port` are; connections wait until start(). `home`: runs the tick thread's handlers; from there
  /// `on_channel` and the channels' callbacks are called. Throws ListenError.
  NetworkThread(asio::io_context& home, const std::string& address, std::uint16_t port, OnChannel on_channel,
                TcpOptions options, TlsListening tls, Limits limits, VisitorsListening visitors = {},
                const std::optional<InheritedSockets>& inherited = std::nullopt);
  NetworkThread(asio::io_context& home, const std::string& address, std::uint16_t port, OnChannel on_channel,
                TcpOptions options, TlsListening tls)
      : NetworkThread(home, address, port, std::move(on_channel), options, std::move(tls), Limits{}) {}
  /// Channels may outlive the sockets; they have to be gone before this.
  ~NetworkThread();

  // All of these: from the tick thread.

  void start();
  /// End the thread, at once; nothing comes or goes after that.
  void stop();
  /// No more connections.
  void closeListener();
  /// Connections accepted from now on meet this certificate and key.
  void setTls(std::shared_ptr<const TlsContext> context);

  /// Call back for what came, but no longer than until `enough` (and for a least number of messages). False:
  /// there is more.
  bool serve(Clock::time_point enough);
  /// Hand over what was sent.
  void flush() { sendOrders(std::nullopt); }
  /// The same at the end of a tick that began at `began`.
  void flushTick(Clock::time_point began) { sendOrders(began); }
  /// When what is being served came; now, if nothing is.
  Clock::time_point now() const { return m_serving ? m_came : Clock::now(); }

  /// Are there datagrams, beside streams?
  bool hasDatagrams() const { return m_port.datagrams != nullptr; }
  /// Datagrams for a session, with keys from its stream, which must be one of ours. Null if there are none.
  std::unique_ptr<SealedChannel> openDatagrams(const ReliableChannel& stream, AeadId aead);

  std::uint16_t port() const { return m_port.streams->port(); }
  std::string address() const { return m_port.streams->address(); }

  /// Send `frame` on all streams, close them, and wait until they are empty, but not longer than `patience`.
  /// From any thread but the network's, while that runs: for a tick thread that does not return.
  void sendLast(const std::string& frame, std::chrono::milliseconds patience);

  /// How long ticks took, begin to last datagram sent. Thread-safe.
  const TickTimes& tickTimes() const { return m_tick_times; }
  /// What became of every datagram until just now; nothing without them. Thread-safe.
  DatagramGateCounters gateCounters() const;
  void resetTickTimes() { m_tick_times.reset(); }
  /// Ask the thread for its counters, which takes it a turn; latestCounters() has them then. Without a
  /// request nothing is copied.
  void askForCounters() { giveOrder({.kind = Order::kReportCounters}); }
  /// As they were when last asked for; all zero before that.
  NetworkCounters latestCounters() const;
  /// CPU time of the thread so far; 0 while it does not run.
  std::chrono::nanoseconds cpuTime();
  /// The rest: when the thread does not run.
  RelayCounters counters() const;
  const TcpListener::Counters& streamCounters() const { return m_port.streams->counters(); }
  /// All zero without a visitors' socket.
  VisitorsListener::Counters visitorCounters() const {
    return m_port.visitors ? m_port.visitors->counters() : VisitorsListener::Counters();
  }

 private:
  friend class RelayedDatagrams;
  friend class RelayedStream;

  /// The network thread's end of a stream. What is not atomic belongs to that thread.
  struct StreamEnd {
    std::uint64_t id = 0;
    std::string peer;  ///< never changes
    std::unique_ptr<ReliableChannel> channel;
    bool busy = false;                     ///< in m_busy
    std::atomic<std::size_t> unsent = 0;   ///< of what was taken over
    std::atomic<std::uint64_t> taken = 0;  ///< bytes that came over from the tick thread, ever
    std::atomic<std::size_t> in = 0;       ///< bytes in transit to it
  };
  /// The same of a session's datagrams.
  struct DatagramsEnd {
    std::uint64_t id = 0;
    std::uint32_t place = 0;  ///< in m_near_datagrams
    std::uint64_t connection = 0;
    AeadId aead = AeadId::kAes128Gcm;
    std::unique_ptr<DatagramService::Channel> channel;  ///< null without keys
    std::atomic<std::int32_t> room = -1;                ///< SealedChannel::room(); negative: none
  };
  /// From the network thread.
  struct Notice {
    enum Kind : std::uint8_t { kMet, kFrame, kClosed, kDatagram } kind = kMet;
    CloseReason reason = CloseReason::kLocal;
    std::uint32_t place = 0;  ///< of datagrams
    std::uint64_t id = 0;
    StreamEnd* stream = nullptr;
    Clock::time_point came{};
  };
  /// From the tick thread.
  struct Order {
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
    StreamEnd* stream = nullptr;
    DatagramsEnd* datagrams = nullptr;
    std::uint64_t number = 0;  ///< limit, epoch, or when the tick began
  };

  // On the tick thread.
  bool renewDatagrams(DatagramsEnd& end, const ReliableChannel& stream, Epoch epoch);
  void giveOrder(const Order& order, std::string_view bytes = {}) { m_orders.add(order, bytes); }
  bool isFull() const { return m_order_box.size() + m_orders.size() > m_limits.mailbox; }
  void sendOrders(std::optional<Clock::time_point> tick_began);
  void onNotice(const Notice& notice, std::string_view bytes);
  void wakeHome();

  // On the network thread.
  void run();
  void obeyOrders();
  void obeyOrder(const Order& order, std::string_view bytes);
  void endTurn();
  void meetStream(std::unique_ptr<ReliableChannel> channel);
  void onFrame(StreamEnd& end, std::string_view frame);
  void onClosed(StreamEnd& end, CloseReason reason);
  void openDatagrams(DatagramsEnd& end, const StreamEnd& stream);
  void noteRoom(DatagramsEnd& end);
  bool hasUnsent() const;
  void addNotice(const Notice& notice, std::string_view bytes = {});
  bool isInFull() const { return m_notice_box.size() + m_notices.size() > m_limits.mailbox; }
  void noteUnsent();
  void reportCounters();

  asio::io_context& m_home;
  OnChannel m_on_channel;
  Limits m_limits;

  // The network thread's.
  asio::io_context m_io{1};
  asio::executor_work_guard<asio::io_context::executor_type> m_work{m_io.get_executor()};
  ServerPort m_port;
  std::unordered_map<const StreamEnd*, std::unique_ptr<StreamEnd>> m_streams;
  std::unordered_map<const DatagramsEnd*, std::unique_ptr<DatagramsEnd>> m_datagrams;
  std::vector<StreamEnd*> m_busy;  ///< those with bytes unsent, at the last count
  Clock::time_point m_count_at{};  ///< when they may be counted again
  Batch<Order> m_taken;
  Batch<Notice> m_notices;
  std::uint64_t m_newest_stream = 0;
  bool m_urgent = false;  ///< the tick thread is to be woken for what is in m_notices
  RelayCounters m_counters;
  TrafficCounters m_traffic;

  // Shared.
  Mailbox<Notice> m_notice_box;
  Mailbox<Order> m_order_box;
  std::atomic<bool> m_home_woken = false;
  std::atomic<bool> m_woken = false;
  std::atomic<bool> m_stopping = false;
  std::atomic<std::size_t> m_unmet = 0;
  TickTimes m_tick_times;
  mutable std::mutex m_gate_mutex;
  DatagramGateCounters m_gate_counters;  ///< a copy, for others to read
  NetworkCounters m_reported;            ///< the same, made when asked for

  // The tick thread's.
  Batch<Order> m_orders;
  Batch<Notice> m_serving_batch;
  std::unordered_map<std::uint64_t, RelayedStream*> m_near_streams;
  /// Places are used again, ids are not: notices still in transit when a session ends reach no channel.
  struct NearDatagrams {
    std::uint64_t id = 0;
    RelayedDatagrams* channel = nullptr;
  };
  std::vector<NearDatagrams> m_near_datagrams;
  std::vector<std::uint32_t> m_free_places;
  std::uint64_t m_newest_datagrams = 0;
  bool m_serving = false;
  Clock::time_point m_came{};
  std::uint64_t m_out_dropped = 0;
  std::uint64_t m_clogged = 0;

  std::thread m_thread;
};

}  // namespace naiad
