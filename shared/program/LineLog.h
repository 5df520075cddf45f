// Log lines, written to a file or stderr by a thread of the log, or by the caller: callers never wait.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace naiad {

/// A log entry: a sentence for people, and its facts by name for programs. The text format writes the
/// sentence, the JSON format both. Both come from one event, so they agree. A plain text is also an event.
struct LogEvent {
  enum class Level { kError, kWarning, kInfo, kDebug };
  /// Names are written unescaped; values are escaped.
  using Fields = std::vector<std::pair<std::string, std::string>>;

  LogEvent(std::string sentence) : text(std::move(sentence)) {}  // NOLINT(google-explicit-constructor)
  LogEvent(const char* p_sentence) : text(p_sentence) {}         // NOLINT(google-explicit-constructor)
  LogEvent(Level severity, std::string sentence) : level(severity), text(std::move(sentence)) {}
  /// `what`: a string literal, "joined". `sentence` contains the fields' values.
  LogEvent(const char* what, std::string sentence, Fields facts)
      : name(what), text(std::move(sentence)), fields(std::move(facts)) {}
  /// Makes a warning; the text for people begins with "warning: ".
  static LogEvent warning(const std::string& sentence) { return {Level::kWarning, "warning: " + sentence}; }
  operator const std::string&() const { return text; }  // NOLINT(google-explicit-constructor)

  const char* name = "note";
  Level level = Level::kInfo;
  std::string text;
  Fields fields;
};

enum class LogFormat {
  kText,  ///< "2026-01-31 13:59:59 sentence", in local time
  kBare,  ///< "sentence"
  kJson,  ///< {"time":"2026-01-31T12:59:59.123Z","level":"info","event":"note","text":"sentence",…}
};

/// Formats the event as a line that ends with a newline, at most `max_bytes` (512 or more) bytes long; longer
/// sentences are truncated. Control characters are escaped; JSON is valid for any bytes.
std::string formatEvent(const LogEvent& event, LogFormat format, std::chrono::system_clock::time_point time,
                        std::size_t max_bytes);

using LogLine = std::function<void(const LogEvent& event)>;

/// If a reader stalls, a disk is full or a pipe has no reader, lines are lost but no caller waits. The thread
/// retries; lines beyond kMaxWaiting are dropped, and afterwards a line reports how many were lost.
class LineLog {
 public:
  /// The writer of the lines. kCaller is for a world process, which has no further threads: the caller writes
  /// each line, or drops it if it would wait. The front process adds the time when it copies the lines into
  /// its log.
  enum class Writer { kThread, kCaller };

  /// Maximum bytes of lines that wait to be written; further lines are dropped.
  static constexpr std::size_t kMaxWaiting = std::size_t{1} << 20;
  /// Maximum bytes of a line; the rest is truncated. A pipe accepts a line of this size as a whole.
  static constexpr std::size_t kMaxLine = 2048;

  /// Appends to this file, created with mode 0640; empty: stderr. Throws std::runtime_error if it cannot be
  /// written, or is a folder or a pipe.
  explicit LineLog(const std::string& path, Writer writer = Writer::kThread);
  /// Waits at most a second for unwritten lines.
  ~LineLog();
  LineLog(const LineLog&) = delete;
  LineLog& operator=(const LineLog&) = delete;

  /// Logs a line; control characters in it are escaped. Thread-safe.
  void operator()(const LogEvent& event);
  /// Sets the format of later lines. Thread-safe.
  void setFormat(LogFormat format);
  /// Logs only events of this level and more severe ones; default: kInfo. Thread-safe.
  void setLevel(LogEvent::Level least);
  /// The descriptor that lines are written to. Does not change when the file is reopened.
  int descriptor() const;

  /// Makes every log of this process that has a thread and a file reopen the file before its next line, for
  /// log rotation. Thread-safe.
  static void reopenAll();
  /// Waits until all logs of this process have written their lines, at most this time. Thread-safe.
  static void waitUntilWritten(std::chrono::milliseconds most);

 private:
  struct Shared;
  std::shared_ptr<Shared> m_shared;  ///< shared with the thread, which may outlive this in a blocked write
};

}  // namespace naiad
