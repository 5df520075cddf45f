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
constexpr std::chrono::milliseconds kPollInterval{
    250};                             ///< interval of checks for messages and a lost connection
constexpr int kTimeoutMillis = 2000;  ///< timeout of connecting, of writing and of acknowledgements
constexpr int kPingMillis = 5000;
constexpr int kMaxPings = 2;  ///< a connection is closed at the next ping if this many are unanswered
/// After this time without a message, the bus is pinged. If it does not answer within this time again, it
/// counts as disconnected, although its connection may recover. Servers without a heartbeat for 6 s expire,
/// so both together are well below that.
constexpr std::chrono::seconds kMaxQuiet{1};
constexpr std::chrono::seconds kCloseTimeout{10};
constexpr const char* kConnectedNews = "the bus is connected";
/// Limit of the library's queue for a subscription, like kMaxBusPending.
constexpr int kMaxPendingBytes = 64 << 20;
constexpr std::size_t kMaxReceiveBatch = 512;  ///< messages taken from a subscription before sending again

template <class T, void (*Destroy)(T*)>
struct NatsDeleter {
  void operator()(T* p_thing) const { Destroy(p_thing); }
};
using Options = std::unique_ptr<natsOptions, NatsDeleter<natsOptions, natsOptions_Destroy>>;
using Connection = std::unique_ptr<natsConnection, NatsDeleter<natsConnection, natsConnection_Destroy>>;
using JetStream = std::unique_ptr<jsCtx, NatsDeleter<jsCtx, jsCtx_Destroy>>;
using Subscription =
    std::unique_ptr<natsSubscription, NatsDeleter<natsSubscription, natsSubscription_Destroy>>;
using Message = std::unique_ptr<natsMsg, NatsDeleter<natsMsg, natsMsg_Destroy>>;

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
    m_sent.wait_for(lock, timeout,
                    [this] { return !m_connected || (!m_queue.hasReliable() && !m_queue.hasBestEffort()); });
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

  void run() {
    Lock lock(m_mutex);
    while (!m_stopping) {
      lock.unlock();
      natsStatus status = NATS_ERR;
      const Connection connection = connect(status);
      lock.lock();
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

  /// Waits until the bus answers a ping, at most kMaxQuiet, and sets m_connected. Called with the lock held.
  void checkAnswer(natsConnection& connection, Lock& lock) {
    lock.unlock();
    const bool answers =
        natsConnection_FlushTimeout(&connection, std::chrono::milliseconds(kMaxQuiet).count()) == NATS_OK;
    lock.lock();
    m_connected = answers;
    logOnce(answers ? kConnectedNews : "warning: the bus does not answer");
  }

  /// Sends and receives until the connection is lost or the bus stops.
  void serve(natsConnection& connection, std::vector<ReceivedSubject>& subjects, Lock& lock) {
    jsCtx* p_made = nullptr;
    natsConnection_JetStream(&p_made, &connection, nullptr);
    const JetStream stream(p_made);
    auto not_before = std::chrono::steady_clock::now();
    auto answered = not_before;
    while (!m_stopping && natsConnection_Status(&connection) == NATS_CONN_STATUS_CONNECTED) {
      const std::uint64_t received = m_inbox.received();
      const bool is_flooded = receive(subjects, lock);
      if (m_inbox.received() > received) {
        answered = std::chrono::steady_clock::now();
        m_connected = true;
      } else if (std::chrono::steady_clock::now() - answered > kMaxQuiet) {
        checkAnswer(connection, lock);
        answered = std::chrono::steady_clock::now();
      }
      const bool may_keep = stream && m_queue.hasReliable() && std::chrono::steady_clock::now() >= not_before;
      if (m_queue.hasBestEffort()) {
        const BusMessage message = m_queue.popBestEffort();
        lock.unlock();
        const bool sent = natsConnection_Publish(&connection, message.subject.c_str(), message.payload.data(),
                                                 static_cast<int>(message.payload.size())) == NATS_OK;
        lock.lock();
        ++(sent ? m_counters.published : m_counters.failures);
      } else if (may_keep) {
        const BusMessage message = m_queue.frontReliable();
        lock.unlock();
        const bool arrived = keep(*stream, message);
        lock.lock();
        ++(arrived ? m_counters.published : m_counters.failures);
        if (arrived) m_queue.ackReliable(message.id);
        if (!arrived) not_before = std::chrono::steady_clock::now() + kConnectAgain;
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
      std::vector<Message> messages;
      lock.unlock();
      natsStatus status = NATS_OK;
      while (messages.size() < kMaxReceiveBatch && (status == NATS_OK || status == NATS_SLOW_CONSUMER)) {
        natsMsg* p_taken = nullptr;
        status = natsSubscription_NextMsg(&p_taken, subject.subscription.get(), 0);
        if (status == NATS_OK) messages.emplace_back(p_taken);
      }
      std::int64_t lost = subject.lost;
      natsSubscription_GetDropped(subject.subscription.get(), &lost);
      lock.lock();
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

  /// Returns true if JetStream has stored the message, now or at an earlier attempt.
  static bool keep(jsCtx& stream, const BusMessage& message) {
    jsPubOptions options;
    jsPubOptions_Init(&options);
    options.MaxWait = kTimeoutMillis;
    options.MsgId = message.id.c_str();
    jsErrCode code{};
    return js_Publish(nullptr, &stream, message.subject.c_str(), message.payload.data(),
                      static_cast<int>(message.payload.size()), &options, &code) == NATS_OK;
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
