#include "host/fleet/AgonesPlatform.h"

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "host/fleet/AgonesRequestScheduler.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/http/HttpExchange.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

constexpr std::chrono::seconds kWatchAgain{1};

/// Returns the given port, else the port in AGONES_SDK_HTTP_PORT, which the cluster sets, else the default.
std::uint16_t portOf(std::uint16_t given) {
  if (given != 0) return given;
  const char* p_text = std::getenv("AGONES_SDK_HTTP_PORT");
  return readNumber<std::uint16_t>(p_text != nullptr ? p_text : "", 1, 65'535)
      .value_or(AgonesPlatform::kDefaultPort);
}

HttpRequest asHttp(const SidecarRequest& request) {
  HttpRequest http{request.method, request.path, "localhost", {{"Connection", "close"}}, request.body};
  if (!request.body.empty()) http.fields.emplace_back("Content-Type", "application/json");
  return http;
}

}  // namespace

/// Only `thread` uses the members, except those that are atomic or guarded by `mutex`.
struct AgonesPlatform::Loop {
  explicit Loop(std::uint16_t port);
  ~Loop();

  void post(std::function<void(AgonesRequestScheduler&)> change);
  void work();
  void watch();
  void handleFacts(const GameServerInfo& facts);
  void note(const std::string& line);

  asio::io_context context{1};  // one thread
  asio::steady_timer timer{context};
  asio::steady_timer watch_timer{context};
  StreamTarget sidecar;
  AgonesRequestScheduler duties;
  bool facts_said = false;
  std::string missing_said;
  std::uint64_t failed_before = 0;
  bool failing = false;

  std::atomic<bool> wants_end = false;
  std::atomic<Clock::rep> ticked = 0;  ///< when the newest reported tick began; 0: none yet
  std::mutex mutex;
  std::condition_variable over;
  PlatformCounters counters;
  bool is_over = false;
  std::optional<PlatformAddress> address;
  std::string news;
  std::thread thread;
};

AgonesPlatform::Loop::Loop(std::uint16_t port) : sidecar{"127.0.0.1", portOf(port)} {
  thread = startWithoutSignals([this] {
    work();
    watch();
    context.run();
  });
}

AgonesPlatform::Loop::~Loop() {
  context.stop();
  thread.join();
}

void AgonesPlatform::Loop::post(std::function<void(AgonesRequestScheduler&)> change) {
  asio::post(context, [this, change = std::move(change)] {
    change(duties);
    work();
  });
}

// Sends the request that is due, or sets the timer for the next one.
void AgonesPlatform::Loop::work() {
  if (const Clock::rep last = ticked) duties.onTick(Clock::time_point(Clock::duration(last)));
  if (const auto request = duties.next(Clock::now())) {
    const auto exchange =
        std::make_shared<HttpExchange>(context, HttpLimits{.body = GameServerInfo::kMaxBytes});
    const auto done = [this, &answer = exchange->answer()](const HttpExchange::Result& result) {
      const bool answered = result.end == HttpExchange::End::kAnswered;
      duties.onResponse(answered ? static_cast<int>(answer.status()) : 0, answered ? answer.body() : "",
                        Clock::now());
      if (duties.facts() && !std::exchange(facts_said, true)) handleFacts(*duties.facts());
      if (std::exchange(missing_said, duties.missing()) != duties.missing())
        note("warning: Agones: the server's resource has no " + duties.missing());
      const bool failed =
          duties.counters().failures > std::exchange(failed_before, duties.counters().failures);
      if (failed != std::exchange(failing, failed))
        note(failed ? "warning: Agones: the sidecar does not answer; trying again"
                    : "Agones: the sidecar answers");
      {
        const std::lock_guard lock(mutex);
        counters = duties.counters();
        is_over = duties.isOver();
      }
      if (duties.isOver()) over.notify_all();
      work();
    };
    exchange->run(sidecar, asHttp(*request), kRequestTimeout, done);
    return;
  }
  timer.expires_at(duties.wake());
  timer.async_wait([this](const std::error_code& error) {
    if (!error) work();
  });
}

/// Sends GET /watch/gameserver. The response is endless and has a line for each change.
void AgonesPlatform::Loop::watch() {
  // Returns false if a line is longer than any that a sidecar sends.
  const auto take = [this, text = std::string()](std::string_view piece) mutable {
    text.append(piece);
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
      if (const auto facts = GameServerInfo::parse(text.substr(0, end), true)) handleFacts(*facts);
      text.erase(0, end + 1);
    }
    return text.size() <= GameServerInfo::kMaxBytes;
  };
  const auto end = [this](const HttpExchange::Result&) {
    watch_timer.expires_after(kWatchAgain);
    watch_timer.async_wait([this](const std::error_code& error) {
      if (!error) watch();
    });
  };
  const HttpRequest request{.target = "/watch/gameserver", .host = "localhost"};
  std::make_shared<HttpExchange>(context, HttpLimits{.body = HttpLimits::kUnlimited})
      ->run(sidecar, request, kRequestTimeout, end, take);
}

void AgonesPlatform::Loop::handleFacts(const GameServerInfo& facts) {
  if (facts.state == "Shutdown") wants_end = true;
  if (facts.port == 0 || facts.address.empty()) return;
  {
    const std::lock_guard lock(mutex);
    if (address && address->host == facts.address && address->port == facts.port) return;
    address = PlatformAddress{facts.address, facts.port};
  }
  note("Agones: players reach " + facts.name + " at " + facts.address + ":" + std::to_string(facts.port));
}

void AgonesPlatform::Loop::note(const std::string& line) {
  const std::lock_guard lock(mutex);
  if (news.size() < 4096) news += (news.empty() ? "" : "; ") + line;
}

AgonesPlatform::AgonesPlatform(std::uint16_t port) : m_loop(std::make_unique<Loop>(port)) {}

AgonesPlatform::~AgonesPlatform() = default;

void AgonesPlatform::notifyReady() {
  m_loop->post([](AgonesRequestScheduler& duties) { duties.setReady(); });
}

void AgonesPlatform::notifyPlayers(const PlatformPlayers& players) {
  m_loop->post([players](AgonesRequestScheduler& duties) { duties.setPlayers(players); });
}

// Called in every tick, so it only stores the time.
void AgonesPlatform::notifyTick(Clock::time_point now) {
  m_loop->ticked = now.time_since_epoch().count();
}

void AgonesPlatform::finish(std::chrono::milliseconds timeout) {
  m_loop->post([](AgonesRequestScheduler& duties) { duties.setEnding(); });
  std::unique_lock lock(m_loop->mutex);
  m_loop->over.wait_for(lock, timeout, [this] { return m_loop->is_over; });
}

std::optional<PlatformAddress> AgonesPlatform::address() const {
  const std::lock_guard lock(m_loop->mutex);
  return m_loop->address;
}

bool AgonesPlatform::popShutdownRequest() {
  return m_loop->wants_end.exchange(false);
}

std::string AgonesPlatform::popLogMessage() {
  const std::lock_guard lock(m_loop->mutex);
  return std::exchange(m_loop->news, "");
}

PlatformCounters AgonesPlatform::counters() const {
  const std::lock_guard lock(m_loop->mutex);
  return m_loop->counters;
}

}  // namespace naiad
