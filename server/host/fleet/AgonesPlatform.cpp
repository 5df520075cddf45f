#include "host/fleet/AgonesPlatform.h"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <charconv>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "host/fleet/SidecarDuties.h"

namespace naiad {

namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr std::chrono::seconds kWatchAgain{1};
constexpr std::uint32_t kMaxHead = 16 * 1024;

/// The variable is set by the cluster for its own sidecar.
std::uint16_t portOf(std::uint16_t given) {
  if (given != 0) return given;
  const char* p_text = std::getenv("AGONES_SDK_HTTP_PORT");
  if (p_text == nullptr) return AgonesPlatform::kDefaultPort;
  std::uint16_t port = 0;
  const char* p_end = p_text + std::strlen(p_text);
  const auto [p_read, error] = std::from_chars(p_text, p_end, port);
  return error == std::errc() && p_read == p_end && port != 0 ? port : AgonesPlatform::kDefaultPort;
}

/// A request, its answer, and the connection for both. Lives as long as something of it is under way.
class SidecarCall : public std::enable_shared_from_this<SidecarCall> {
 public:
  /// An HTTP status and its body; 0: none came.
  using Done = std::function<void(int status, const std::string& body)>;

  SidecarCall(boost::asio::io_context& context, Done done) : m_stream(context), m_done(std::move(done)) {
    m_parser.header_limit(kMaxHead);
    m_parser.body_limit(GameServerFacts::kMaxBytes);
  }

  void start(const tcp::endpoint& sidecar, const SidecarRequest& request) {
    m_request.method_string(request.method);
    m_request.target(request.path);
    m_request.version(11);
    m_request.set(http::field::host, "localhost");
    m_request.keep_alive(false);
    if (!request.body.empty()) m_request.set(http::field::content_type, "application/json");
    m_request.body() = request.body;
    m_request.prepare_payload();
    m_stream.expires_after(AgonesPlatform::kPatience);
    m_stream.async_connect(sidecar, [self = shared_from_this()](const error_code& error) {
      error ? self->finish(0) : self->write();
    });
  }

 private:
  void write() {
    http::async_write(m_stream, m_request, [self = shared_from_this()](const error_code& error, std::size_t) {
      error ? self->finish(0) : self->read();
    });
  }
  void read() {
    http::async_read(m_stream, m_buffer, m_parser,
                     [self = shared_from_this()](const error_code& error, std::size_t) {
                       self->finish(error ? 0 : static_cast<int>(self->m_parser.get().result_int()));
                     });
  }
  void finish(int status) { m_done(status, status != 0 ? m_parser.get().body() : std::string()); }

  boost::beast::tcp_stream m_stream;
  boost::beast::flat_buffer m_buffer;
  http::request<http::string_body> m_request;
  http::response_parser<http::string_body> m_parser;
  Done m_done;
};

/// GET /watch/gameserver: an answer that does not end, a line for each change.
class SidecarWatch : public std::enable_shared_from_this<SidecarWatch> {
 public:
  using Line = std::function<void(const std::string& line)>;
  using Over = std::function<void()>;

  SidecarWatch(boost::asio::io_context& context, Line line, Over over)
      : m_stream(context), m_line(std::move(line)), m_over(std::move(over)) {
    m_parser.header_limit(kMaxHead);
    m_parser.body_limit(boost::none);  // each line has a limit
  }

  void start(const tcp::endpoint& sidecar) {
    m_request.method(http::verb::get);
    m_request.target("/watch/gameserver");
    m_request.version(11);
    m_request.set(http::field::host, "localhost");
    m_stream.expires_after(AgonesPlatform::kPatience);
    m_stream.async_connect(sidecar, [self = shared_from_this()](const error_code& error) {
      error ? self->m_over() : self->write();
    });
  }

 private:
  void write() {
    http::async_write(m_stream, m_request, [self = shared_from_this()](const error_code& error, std::size_t) {
      error ? self->m_over() : self->readHead();
    });
  }
  // The head may come with the first change, however late that is.
  void readHead() {
    m_stream.expires_never();
    http::async_read_header(m_stream, m_buffer, m_parser,
                            [self = shared_from_this()](const error_code& error, std::size_t) {
                              const bool good = !error && self->m_parser.get().result() == http::status::ok;
                              good ? self->readBody() : self->m_over();
                            });
  }
  void readBody() {
    m_parser.get().body().data = m_piece;
    m_parser.get().body().size = sizeof m_piece;
    http::async_read_some(m_stream, m_buffer, m_parser,
                          [self = shared_from_this()](const error_code& error, std::size_t) {
                            const bool goes_on = !error || error == http::error::need_buffer;
                            goes_on && self->takePiece() ? self->readBody() : self->m_over();
                          });
  }
  /// False: no sidecar sends such a line, or it was the end.
  bool takePiece() {
    m_text.append(m_piece, sizeof m_piece - m_parser.get().body().size);
    for (std::size_t end = m_text.find('\n'); end != std::string::npos; end = m_text.find('\n')) {
      m_line(m_text.substr(0, end));
      m_text.erase(0, end + 1);
    }
    return !m_parser.is_done() && m_text.size() <= GameServerFacts::kMaxBytes;
  }

  boost::beast::tcp_stream m_stream;
  boost::beast::flat_buffer m_buffer{kMaxHead + 4096};
  http::request<http::empty_body> m_request;
  http::response_parser<http::buffer_body> m_parser;
  char m_piece[4096] = {};
  std::string m_text;
  Line m_line;
  Over m_over;
};

}  // namespace

/// All but what has a mutex or is atomic is the thread's.
struct AgonesPlatform::Loop {
  explicit Loop(std::uint16_t port);
  ~Loop();

  void post(std::function<void(SidecarDuties&)> change);
  void work();
  void watch();
  void takeFacts(const GameServerFacts& facts);
  void note(const std::string& line);

  boost::asio::io_context context{1};  // one thread
  boost::asio::steady_timer timer{context};
  boost::asio::steady_timer watch_timer{context};
  tcp::endpoint sidecar;
  SidecarDuties duties;
  bool facts_said = false;
  std::string missing_said;
  std::uint64_t failed_before = 0;
  bool failing = false;

  std::atomic<bool> wants_end = false;
  std::atomic<Clock::rep> ticked = 0;  ///< when the last tick ended; 0: none has
  std::mutex mutex;
  std::condition_variable over;
  PlatformCounters counters;
  bool is_over = false;
  std::optional<PlatformAddress> address;
  std::string news;
  std::thread thread;
};

AgonesPlatform::Loop::Loop(std::uint16_t port)
    : sidecar(boost::asio::ip::address_v4::loopback(), portOf(port)) {
  // Signals are for the threads that were there before.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread = std::thread([this] {
    work();
    watch();
    context.run();
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

AgonesPlatform::Loop::~Loop() {
  context.stop();
  thread.join();
}

void AgonesPlatform::Loop::post(std::function<void(SidecarDuties&)> change) {
  boost::asio::post(context, [this, change = std::move(change)] {
    change(duties);
    work();
  });
}

// Ask for what is due, and come again when something may be.
void AgonesPlatform::Loop::work() {
  if (const Clock::rep last = ticked) duties.noteTick(Clock::time_point(Clock::duration(last)));
  if (const auto request = duties.next(Clock::now())) {
    const auto done = [this](int status, const std::string& body) {
      duties.onAnswer(status, body, Clock::now());
      if (duties.facts() && !std::exchange(facts_said, true)) takeFacts(*duties.facts());
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
    std::make_shared<SidecarCall>(context, done)->start(sidecar, *request);
    return;
  }
  timer.expires_at(duties.wake());
  timer.async_wait([this](const error_code& error) {
    if (!error) work();
  });
}

void AgonesPlatform::Loop::watch() {
  const auto line = [this](const std::string& text) {
    if (const auto facts = GameServerFacts::parse(text, true)) takeFacts(*facts);
  };
  const auto end = [this] {
    watch_timer.expires_after(kWatchAgain);
    watch_timer.async_wait([this](const error_code& error) {
      if (!error) watch();
    });
  };
  std::make_shared<SidecarWatch>(context, line, end)->start(sidecar);
}

void AgonesPlatform::Loop::takeFacts(const GameServerFacts& facts) {
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
  m_loop->post([](SidecarDuties& duties) { duties.setReady(); });
}

void AgonesPlatform::notifyPlayers(const PlatformPlayers& players) {
  m_loop->post([players](SidecarDuties& duties) { duties.setPlayers(players); });
}

// On the tick path, so no more than this.
void AgonesPlatform::notifyTick(Clock::time_point now) {
  m_loop->ticked = now.time_since_epoch().count();
}

void AgonesPlatform::finish(std::chrono::milliseconds patience) {
  m_loop->post([](SidecarDuties& duties) { duties.setEnding(); });
  std::unique_lock lock(m_loop->mutex);
  m_loop->over.wait_for(lock, patience, [this] { return m_loop->is_over; });
}

std::optional<PlatformAddress> AgonesPlatform::address() const {
  const std::lock_guard lock(m_loop->mutex);
  return m_loop->address;
}

bool AgonesPlatform::takeEnd() {
  return m_loop->wants_end.exchange(false);
}

std::string AgonesPlatform::takeNews() {
  const std::lock_guard lock(m_loop->mutex);
  return std::exchange(m_loop->news, "");
}

PlatformCounters AgonesPlatform::counters() const {
  const std::lock_guard lock(m_loop->mutex);
  return m_loop->counters;
}

}  // namespace naiad
