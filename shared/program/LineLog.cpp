#include "shared/program/LineLog.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

#include "shared/json/Json.h"
#include "shared/program/LogText.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxField = 128;  ///< maximum bytes of a JSON value: addresses, names, refusals

std::string localTime(std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  localtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S ", &parts);
  return text;
}

std::string universalTime(std::chrono::system_clock::time_point time) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
  const auto millis = std::chrono::duration_cast<std::chrono::milliseconds>(time - seconds).count();
  const std::time_t count = std::chrono::system_clock::to_time_t(seconds);
  std::tm parts{};
  gmtime_r(&count, &parts);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S", &parts);
  char text[48];
  std::snprintf(text, sizeof text, "%s.%03dZ", date, static_cast<int>(millis));
  return text;
}

const char* nameOf(LogEvent::Level level) {
  static constexpr const char* kNames[] = {"error", "warning", "info", "debug"};
  return kNames[static_cast<std::size_t>(level)];
}

std::string asJson(const LogEvent& event, std::string_view text, const std::string& time) {
  Json line{{"time", time}, {"level", nameOf(event.level)}, {"event", event.name}, {"text", oneLine(text)}};
  for (const auto& [name, value] : event.fields) line.set(name, oneLine(value).substr(0, kMaxField));
  return line.toString() + '\n';  // half a character that the cut left becomes U+FFFD
}

constexpr std::chrono::milliseconds kRetry{200};        ///< pause after a failed write
constexpr std::chrono::milliseconds kLastChance{1000};  ///< time for writers to finish when the process ends
constexpr int kPollMillis = 100;                        ///< interval of checks whether the thread must end
constexpr std::size_t kPipePiece = 4096;  ///< PIPE_BUF: bytes that a pipe accepts without splitting
constexpr std::size_t kFilePiece = std::size_t{64} << 10;

constinit std::atomic<unsigned> g_openings = 0;       ///< number of reopenAll() calls
constinit std::atomic<std::int64_t> g_unwritten = 0;  ///< unwritten bytes of all logs

LogEvent lossEvent(std::uint64_t lost, int error) {
  const std::string why = error == 0 ? "its reader is too slow" : std::generic_category().message(error);
  return {LogEvent::Level::kError, std::to_string(lost) + (lost == 1 ? " log line was" : " log lines were") +
                                       " lost: the log could not be written (" + why + ")"};
}

bool isRegular(int file) {
  struct stat facts {};
  return fstat(file, &facts) == 0 && S_ISREG(facts.st_mode);
}

/// Returns a descriptor, or -1 with errno. ENXIO: a pipe or the like, which could block the server.
int openLog(const std::string& path) {
  constexpr int kAppend = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  const int file = ::open(path.c_str(), kAppend, 0640);
  struct stat facts {};
  if (file < 0 || (fstat(file, &facts) == 0 && (S_ISREG(facts.st_mode) || S_ISCHR(facts.st_mode))))
    return file;
  ::close(file);
  errno = ENXIO;
  return -1;
}

/// Returns the part of `bytes` to write at once: whole lines, if they fit.
std::string_view nextPiece(std::string_view bytes, std::size_t most) {
  if (bytes.size() <= most) return bytes;
  const std::size_t end = bytes.rfind('\n', most - 1);
  return bytes.substr(0, end == std::string_view::npos ? most : end + 1);
}

}  // namespace

std::string formatEvent(const LogEvent& event, LogFormat format, std::chrono::system_clock::time_point time,
                        std::size_t max_bytes) {
  if (format == LogFormat::kJson) {
    const std::string stamp = universalTime(time);
    std::string_view text = event.text;
    for (std::string line = asJson(event, text, stamp);; line = asJson(event, text, stamp)) {
      if (line.size() <= max_bytes || text.empty()) return line;
      text = text.substr(0, text.size() / 2);
    }
  }
  std::string line = (format == LogFormat::kText ? localTime(time) : std::string()) + oneLine(event.text);
  if (line.size() >= max_bytes) line.resize(max_bytes - 1);
  return line + '\n';
}

struct LineLog::Shared : std::enable_shared_from_this<Shared> {
  Shared(std::string log_path, int opened, bool has_thread)
      : path(std::move(log_path)), file(opened), threaded(has_thread) {}
  ~Shared() {
    g_unwritten -= static_cast<std::int64_t>(waiting.size() + out.size());
    if (!path.empty()) ::close(file);
  }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  void add(const LogEvent& event);
  std::string asLine(const LogEvent& event) const {
    return formatEvent(event, format, std::chrono::system_clock::now(), kMaxLine);
  }
  void start();
  bool keep(const std::string& line);
  bool writeNow(const std::string& line);
  void run();
  void awaitWork();
  bool write(int patience_millis);
  bool fail(int why);
  void reopen();

  const std::string path;  ///< empty: stderr
  const int file;
  const bool threaded;
  std::atomic<LogFormat> format = threaded ? LogFormat::kText : LogFormat::kBare;
  std::atomic<LogEvent::Level> least = LogEvent::Level::kInfo;

  std::mutex mutex;
  std::condition_variable changed;
  // Guarded by `mutex`.
  std::string waiting;
  std::uint64_t lost = 0;
  bool started = false;
  bool closing = false;
  bool done = false;
  int error = 0;  ///< copy of `problem` for add()

  // Used only by the writer.
  std::string out;
  int problem = 0;  ///< errno of the last failed write; 0: the reader is too slow
  unsigned openings = g_openings;
};

void LineLog::Shared::add(const LogEvent& event) {
  if (event.level > least) return;
  std::string line = asLine(event);
  const std::lock_guard lock(mutex);
  if (threaded && !std::exchange(started, true)) start();
  if (lost > 0) line = asLine(lossEvent(lost, error)) + line;
  if (threaded ? keep(line) : writeNow(line)) {
    lost = 0;
  } else {
    ++lost;
  }
}

// Called when the first line is logged, because a server must fork its worlds before it has threads.
void LineLog::Shared::start() {
  // Also runs if a game calls exit() in a handler.
  [[maybe_unused]] static const int registered = std::atexit([] { waitUntilWritten(kLastChance); });
  startWithoutSignals([shared = shared_from_this()] { shared->run(); }).detach();
}

bool LineLog::Shared::keep(const std::string& line) {
  if (waiting.size() + line.size() > kMaxWaiting) return false;
  waiting += line;
  g_unwritten += static_cast<std::int64_t>(line.size());
  changed.notify_one();
  return true;
}

// Bytes that cannot be written at once are lost, because there is no thread to retry.
bool LineLog::Shared::writeNow(const std::string& line) {
  out = line;
  g_unwritten += static_cast<std::int64_t>(out.size());
  const bool written = write(0);
  g_unwritten -= static_cast<std::int64_t>(out.size());
  out.clear();
  error = problem;
  return written;
}

// Writes `out`. Returns false if it could not be written completely.
bool LineLog::Shared::write(int patience_millis) {
  const std::size_t most = isRegular(file) ? kFilePiece : kPipePiece;
  while (!out.empty()) {
    pollfd ready{file, POLLOUT, 0};
    if (poll(&ready, 1, patience_millis) <= 0) return fail(0);
    const std::string_view piece = nextPiece(out, most);
    const ssize_t written = ::write(file, piece.data(), piece.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return fail(errno == EAGAIN ? 0 : errno);
    g_unwritten -= written;
    out.erase(0, static_cast<std::size_t>(written));
  }
  return true;
}

bool LineLog::Shared::fail(int why) {
  problem = why;
  return false;
}

void LineLog::Shared::reopen() {
  const unsigned asked = g_openings;
  if (path.empty() || std::exchange(openings, asked) == asked) return;
  const int opened = openLog(path);
  if (opened < 0) return;
  dup3(opened, file, O_CLOEXEC);
  ::close(opened);
}

void LineLog::Shared::awaitWork() {
  std::unique_lock lock(mutex);
  if (lost > 0 && waiting.empty()) {  // all earlier lines are written
    waiting = asLine(lossEvent(std::exchange(lost, 0), error));
    g_unwritten += static_cast<std::int64_t>(waiting.size());
  }
  changed.wait(lock, [this] { return closing || !waiting.empty(); });
  out = std::exchange(waiting, {});
}

void LineLog::Shared::run() {
  for (;;) {
    awaitWork();
    if (out.empty()) break;
    reopen();
    while (!write(kPollMillis)) {
      std::unique_lock lock(mutex);
      error = problem;
      if (closing) break;
      if (problem != 0) changed.wait_for(lock, kRetry, [this] { return closing; });
      lock.unlock();
      reopen();
    }
    const std::lock_guard lock(mutex);
    if (closing && !out.empty()) break;
  }
  const std::lock_guard lock(mutex);
  done = true;
  changed.notify_all();
}

LineLog::LineLog(const std::string& path, Writer writer) {
  const int file = path.empty() ? STDERR_FILENO : openLog(path);
  if (file < 0) {
    throw std::runtime_error(
        "The log file " + path + " cannot be written: " +
        (errno == ENXIO ? "it is not a regular file." : std::generic_category().message(errno) + "."));
  }
  m_shared = std::make_shared<Shared>(path, file, writer == Writer::kThread);
}

LineLog::~LineLog() {
  std::unique_lock lock(m_shared->mutex);
  if (!m_shared->started) return;
  m_shared->closing = true;
  m_shared->changed.notify_all();
  m_shared->changed.wait_for(lock, kLastChance, [this] { return m_shared->done; });
}

void LineLog::operator()(const LogEvent& event) {
  m_shared->add(event);
}

void LineLog::setFormat(LogFormat format) {
  m_shared->format = format;
}

void LineLog::setLevel(LogEvent::Level least) {
  m_shared->least = least;
}

int LineLog::descriptor() const {
  return m_shared->file;
}

void LineLog::reopenAll() {
  ++g_openings;
}

void LineLog::waitUntilWritten(std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  while (g_unwritten > 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace naiad
