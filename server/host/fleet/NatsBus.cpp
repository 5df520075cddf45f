#include "host/fleet/Bus.h"

#ifdef NAIAD_NATS
#include <nats/nats.h>
#endif

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "host/fleet/BusQueue.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

#ifdef NAIAD_NATS

namespace {

constexpr std::chrono::seconds kConnectAgain{1};
constexpr std::chrono::milliseconds kPollInterval{250};  ///< checks for messages and a lost connection
constexpr int kTimeoutMillis = 2000;  ///< timeout of connecting, of writing and of acknowledgements
constexpr int kPingMillis = 5000;
constexpr int kMaxPings = 2;  ///< a connection is closed at the next ping if this many are not answered
/// After this time without a message, the bus is asked for an answer. If none comes within this time again,
/// the bus counts as disconnected, although its connection may recover. Servers without a heartbeat for 6 s
/// expire, so both together are well below that.
constexpr std::chrono::seconds kMaxQuiet{1};
constexpr std::chrono::seconds kCloseTimeout{10};
constexpr const char* kConnectedNews = "the bus is connected";
/// Limit of the library's queue for a subscription, like kMaxBusPending.
constexpr int kMaxPendingBytes = 64 << 20;
constexpr std::size_t kMaxReceiveBatch = 512;  ///< messages taken from a subscription before sending again

template <auto Destroy>
struct NatsDeleter {
  void operator()(auto* p_thing) const { Destroy(p_thing); }
};
using Options = std::unique_ptr<natsOptions, NatsDeleter<natsOptions_Destroy>>;
using Connection = std::unique_ptr<natsConnection, NatsDeleter<natsConnection_Destroy>>;
using JetStream = std::unique_ptr<jsCtx, NatsDeleter<jsCtx_Destroy>>;
using Subscription = std::unique_ptr<natsSubscription, NatsDeleter<natsSubscription_Destroy>>;
using Message = std::unique_ptr<natsMsg, NatsDeleter<natsMsg_Destroy>>;

/// Turns off the library's reconnects, which would buffer unsent messages: NatsBus has bounded queues.
Options optionsOf(const BusSettings& settings) {
  natsOptions* p_made = nullptr;
  if (natsOptions_Create(&p_made) != NATS_OK) return nullptr;
  Options options(p_made);
  bool good = natsOptions_SetURL(p_made, settings.url.c_str()) == NATS_OK &&
              natsOptions_SetName(p_made, "naiad") == NATS_OK &&
              natsOptions_SetAllowReconnect(p_made, false) == NATS_OK &&
              natsOptions_SetTimeout(p_made, kTimeoutMillis) == NATS_OK &&
              natsOptions_SetWriteDeadline(p_made, kTimeoutMillis) == NATS_OK &&
              natsOptions_SetPingInterval(p_made, kPingMillis) == NATS_OK &&
              natsOptions_SetMaxPingsOut(p_made, kMaxPings) == NATS_OK;
  if (settings.isEncrypted()) good = good && natsOptions_SetSecure(p_made, true) == NATS_OK;
  if (!settings.authorities.empty())
    good = good && natsOptions_LoadCATrustedCertificates(p_made, settings.authorities.c_str()) == NATS_OK;
  if (!settings.credentials.empty())
    good = good &&
           natsOptions_SetUserCredentialsFromFiles(p_made, settings.credentials.c_str(), nullptr) == NATS_OK;
  return good ? std::move(options) : nullptr;
}

/// A bus that connects, publishes and receives on a thread of its own.
class NatsBus : public Bus {
 public:
  NatsBus(BusSettings settings, int max_pending)
      : m_settings(std::move(settings)), m_max_pending(max_pending) {
    m_thread = startWithoutSignals([this] { run(); });
  }
  ~NatsBus() override {
    {
      const std::lock_guard lock(m_mutex);
      m_stopping = true;
    }
    m_wake.notify_all();
    m_thread.join();
  }

  void publish(BusMessage message) override {
    {
      const std::lock_guard lock(m_mutex);
      m_queue.push(std::move(message));
    }
    m_wake.notify_all();
  }
  bool isConnected() const override {
    const std::lock_guard lock(m_mutex);
    return m_connected;
  }
  std::vector<BusMessage> popMessages() override {
    const std::lock_guard lock(m_mutex);
    return m_inbox.popAll();
  }
  void finish(std::chrono::milliseconds timeout) override {
    std::unique_lock lock(m_mutex);
    m_sent.wait_for(lock, timeout, [this] { return !m_connected || m_queue.isEmpty(); });
  }
  BusCounters counters() const override {
    const std::lock_guard lock(m_mutex);
    BusCounters counters = m_counters;
    counters.dropped = m_queue.dropped();
    counters.received = m_inbox.received();
    counters.ignored = m_inbox.ignored();
    return counters;
  }
  std::string popLogMessage() override {
    const std::lock_guard lock(m_mutex);
    return std::exchange(m_log_message, "");
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  struct ReceivedSubject {
    Subscription subscription;
    std::int64_t lost = 0;  ///< lost messages of this subscription that are counted
  };

  /// Calls a function of the library, which may take long, without the lock.
  static auto unlocked(Lock& lock, const auto& call) {
    lock.unlock();
    auto result = call();
    lock.lock();
    return result;
  }

  void run() {
    Lock lock(m_mutex);
    while (!m_stopping) {
      natsStatus status = NATS_ERR;
      const Connection connection = unlocked(lock, [&] { return connect(status); });
      onConnectionChange(connection != nullptr, status);
      if (connection) {
        std::vector<ReceivedSubject> subjects = subscribe(*connection);
        serve(*connection, subjects, lock);
        close(*connection, lock);
      }
      m_connected = false;
      m_sent.notify_all();
      if (!m_stopping) m_wake.wait_for(lock, kConnectAgain, [this] { return m_stopping; });
    }
  }

  Connection connect(natsStatus& status) {
    const Options options = optionsOf(m_settings);
    const auto on_closed = [](natsConnection*, void* p_bus) {
      auto& bus = *static_cast<NatsBus*>(p_bus);
      const std::lock_guard lock(bus.m_mutex);
      bus.m_closed = true;
      bus.m_wake.notify_all();
    };
    if (options) natsOptions_SetClosedCB(options.get(), on_closed, this);
    natsConnection* p_made = nullptr;
    status = options ? natsConnection_Connect(&p_made, options.get()) : NATS_INVALID_ARG;
    return Connection(status == NATS_OK ? p_made : nullptr);
  }

  /// Logs a new state once. The address is not logged, because it may contain a password.
  void onConnectionChange(bool connected, natsStatus status) {
    m_connected = connected;
    m_counters.connections += connected ? 1 : 0;
    m_counters.failures += connected ? 0 : 1;
    logOnce(connected ? kConnectedNews
                      : std::string("warning: the bus cannot be reached (") + natsStatus_GetText(status) +
                            "); trying again");
  }
  void logOnce(const std::string& news) {
    if (std::exchange(m_last_news, news) != news) m_log_message = news;
  }

  /// Closes the connection and waits until the library no longer reads from it: version 3.4 lets its thread
  /// use a subscription that is being destroyed. Called with the lock held.
  void close(natsConnection& connection, Lock& lock) {
    if (!m_stopping) logOnce("warning: the connection to the bus was lost; connecting again");
    lock.unlock();
    natsConnection_Close(&connection);
    lock.lock();
    m_wake.wait_for(lock, kCloseTimeout, [this] { return m_closed; });
    m_closed = false;
  }

  /// Asks the bus for an answer, and sets whether it counts as connected. Called with the lock held.
  void checkAnswer(natsConnection& connection, Lock& lock) {
    m_connected = unlocked(lock, [&] {
      return natsConnection_FlushTimeout(&connection, std::chrono::milliseconds(kMaxQuiet).count()) ==
             NATS_OK;
    });
    logOnce(m_connected ? kConnectedNews : "warning: the bus does not answer");
  }

  /// Sends and receives until the connection is lost or the bus stops.
  void serve(natsConnection& connection, std::vector<ReceivedSubject>& subjects, Lock& lock) {
    jsCtx* p_made = nullptr;
    natsConnection_JetStream(&p_made, &connection, nullptr);
    const JetStream stream(p_made);
    using Clock = std::chrono::steady_clock;
    auto not_before = Clock::now();
    auto answered = not_before;
    while (!m_stopping && natsConnection_Status(&connection) == NATS_CONN_STATUS_CONNECTED) {
      const std::uint64_t received = m_inbox.received();
      const bool is_flooded = receive(subjects, lock);
      if (m_inbox.received() > received) {
        answered = Clock::now();
        m_connected = true;
      } else if (Clock::now() - answered > kMaxQuiet) {
        checkAnswer(connection, lock);
        answered = Clock::now();
      }
      const bool has_best_effort = m_queue.hasBestEffort();
      if (has_best_effort || (stream && m_queue.hasReliable() && Clock::now() >= not_before)) {
        const BusMessage message = has_best_effort ? m_queue.popBestEffort() : m_queue.frontReliable();
        const bool sent = unlocked(lock, [&] { return send(connection, stream.get(), message); });
        ++(sent ? m_counters.published : m_counters.failures);
        if (sent) m_queue.ackReliable(message.id);
        if (!sent && !has_best_effort) not_before = Clock::now() + kConnectAgain;
      } else {
        m_sent.notify_all();
        if (!is_flooded) m_wake.wait_for(lock, kPollInterval);
      }
    }
  }

  /// Subscribes to all subjects. If the bus refuses one for lack of permission, only its log shows it.
  std::vector<ReceivedSubject> subscribe(natsConnection& connection) const {
    std::vector<ReceivedSubject> made;
    for (const std::string& subject : m_settings.subjects) {
      natsSubscription* p_made = nullptr;
      if (natsConnection_SubscribeSync(&p_made, &connection, subject.c_str()) != NATS_OK) continue;
      natsSubscription_SetPendingLimits(p_made, m_max_pending, kMaxPendingBytes);
      made.push_back({Subscription(p_made)});
    }
    return made;
  }

  /// Moves arrived messages to the inbox, which holds one of each subject, and counts lost ones. Returns true
  /// if more may wait. Called with the lock held.
  bool receive(std::vector<ReceivedSubject>& subjects, Lock& lock) {
    bool is_full = false;
    for (ReceivedSubject& subject : subjects) {
      std::int64_t lost = subject.lost;
      const std::vector<Message> messages = unlocked(lock, [&] {
        std::vector<Message> batch;
        natsStatus status = NATS_OK;
        while (batch.size() < kMaxReceiveBatch && (status == NATS_OK || status == NATS_SLOW_CONSUMER)) {
          natsMsg* p_taken = nullptr;
          status = natsSubscription_NextMsg(&p_taken, subject.subscription.get(), 0);
          if (status == NATS_OK) batch.emplace_back(p_taken);
        }
        natsSubscription_GetDropped(subject.subscription.get(), &lost);
        return batch;
      });
      is_full = is_full || messages.size() == kMaxReceiveBatch;
      if (lost != subject.lost) logOnce("warning: messages of the bus were lost, because too many arrived");
      m_counters.lost += static_cast<std::uint64_t>(lost - std::exchange(subject.lost, lost));
      for (const Message& message : messages) {
        m_inbox.put(
            natsMsg_GetSubject(message.get()),
            {natsMsg_GetData(message.get()), static_cast<std::size_t>(natsMsg_GetDataLength(message.get()))});
      }
    }
    return is_full;
  }

  /// Sends a message. Returns true if it was sent; for a reliable one, if JetStream has stored it, now or at
  /// an earlier attempt.
  static bool send(natsConnection& connection, jsCtx* p_stream, const BusMessage& message) {
    const char* const p_subject = message.subject.c_str();
    const auto size = static_cast<int>(message.payload.size());
    if (message.id.empty())
      return natsConnection_Publish(&connection, p_subject, message.payload.data(), size) == NATS_OK;
    jsPubOptions options;
    jsPubOptions_Init(&options);
    options.MaxWait = kTimeoutMillis;
    options.MsgId = message.id.c_str();
    jsErrCode code{};
    return js_Publish(nullptr, p_stream, p_subject, message.payload.data(), size, &options, &code) == NATS_OK;
  }

  const BusSettings m_settings;
  const int m_max_pending;
  mutable std::mutex m_mutex;
  std::condition_variable m_wake;
  std::condition_variable m_sent;
  BusQueue m_queue;
  BusInbox m_inbox;
  bool m_connected = false;
  bool m_stopping = false;
  bool m_closed = false;  ///< the library reports that it has closed the connection
  BusCounters m_counters;
  std::string m_last_news;
  std::string m_log_message;
  std::thread m_thread;
};

}  // namespace

std::unique_ptr<Bus> connectBus(const BusSettings& settings, int max_pending) {
  return std::make_unique<NatsBus>(settings, max_pending);
}

#else

std::unique_ptr<Bus> connectBus(const BusSettings& settings, int /*max_pending*/) {
  throw std::logic_error(validateBusSettings(settings));
}

#endif

}  // namespace naiad
