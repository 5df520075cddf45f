// A log never blocks its caller, loses lines only if it must, and reports how many. Its events are sentences
// or JSON objects.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "shared/program/LineLog.h"
#include "shared/program/LogText.h"
#include "shared/program/ProcessSetup.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

class LineLogTest : public testing::Test {
 protected:
  LineLogTest() { ignoreBrokenPipes(); }

  std::string read() const { return test::contentOf(path); }
  bool comes(const std::string& part) const {
    for (const auto end = Clock::now() + 30s; Clock::now() < end; usleep(1000)) {
      if (read().find(part) != std::string::npos) return true;
    }
    return false;
  }

  test::TempFolder base;
  const fs::path path = base / "log";
};

/// Returns the sum of the lost lines that the log reports.
long linesLost(const std::string& text) {
  constexpr std::string_view kSaid = " log line";
  long lost = 0;
  for (std::size_t at = text.find(kSaid); at != std::string::npos; at = text.find(kSaid, at + 1))
    lost += std::stol(text.substr(text.find_last_of(" \n", at - 1) + 1));
  return lost;
}

/// True if, within 30 s, a thread tried to make a file exceed RLIMIT_FSIZE. The writer thread of a log blocks
/// signals, so its SIGXFSZ then stays pending.
bool hasFailedToWrite() {
  constexpr std::uint64_t kBit = std::uint64_t{1} << (SIGXFSZ - 1);
  for (const auto end = Clock::now() + 30s; Clock::now() < end; usleep(1000)) {
    for (const auto& thread : fs::directory_iterator("/proc/self/task")) {
      std::ifstream status(thread.path() / "status");
      for (std::string line; std::getline(status, line);) {
        if (line.starts_with("SigPnd:") && (std::stoull(line.substr(7), nullptr, 16) & kBit) != 0)
          return true;
      }
    }
  }
  return false;
}

/// Replaces standard error by a pipe of one page.
class StderrPipe {
 public:
  StderrPipe() : m_before(dup(STDERR_FILENO)) {
    if (pipe(m_ends) != 0) throw std::runtime_error("no pipe");
    fcntl(m_ends[1], F_SETPIPE_SZ, 4096);
    dup2(m_ends[1], STDERR_FILENO);
    close(m_ends[1]);
  }
  ~StderrPipe() {
    dup2(m_before, STDERR_FILENO);
    close(m_before);
    closeReader();
  }
  void closeReader() {
    if (m_ends[0] >= 0) close(m_ends[0]);
    m_ends[0] = -1;
  }
  /// Reads until `part` has arrived.
  std::string readUntil(const std::string& part) {
    std::string all;
    const auto end = Clock::now() + 30s;
    while (all.find(part) == std::string::npos && Clock::now() < end) {
      pollfd ready{m_ends[0], POLLIN, 0};
      char piece[65536];
      if (poll(&ready, 1, 100) <= 0) continue;
      const ssize_t size = ::read(m_ends[0], piece, sizeof piece);
      if (size > 0) all.append(piece, static_cast<std::size_t>(size));
    }
    return all;
  }

 private:
  int m_before;
  int m_ends[2] = {-1, -1};
};

TEST_F(LineLogTest, LinesHaveTimestampsAndFileIsNotWorldReadable) {
  LineLog log(path);
  log("first");
  ASSERT_TRUE(comes("first\n"));
  EXPECT_EQ(read().size(), std::string("2025-01-31 23:59:59 first\n").size()) << read();
  struct stat facts {};
  ASSERT_EQ(stat(path.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0137, 0u) << std::oct << facts.st_mode;
}

TEST_F(LineLogTest, DestructorWritesAllLines) {
  {
    LineLog log(path);
    log("last words");
  }
  EXPECT_NE(read().find("last words\n"), std::string::npos);
}

TEST_F(LineLogTest, StalledReaderDoesNotBlockAndLossIsReported) {
  StderrPipe pipe;
  LineLog log("");
  const std::string line(1000, 'x');
  const int kLines = 3 * static_cast<int>(LineLog::kMaxWaiting / line.size());
  for (int i = 0; i < kLines; ++i)
    log("line " + std::to_string(i) + ";" + line);  // nothing reads the pipe yet
  std::string said = pipe.readUntil(" log lines were lost: the log could not be written");
  EXPECT_NE(said.find("line 0;"), std::string::npos) << "what fits is kept";
  log("it goes on");
  said += pipe.readUntil("it goes on");
  const auto kept = std::count(said.begin(), said.end(), ';');
  EXPECT_LT(kept, kLines);
  EXPECT_EQ(linesLost(said), kLines - kept);
}

TEST_F(LineLogTest, ClosedReaderDoesNotEndTheProgram) {
  StderrPipe pipe;
  LineLog log("");
  log("first");
  pipe.readUntil("first");
  pipe.closeReader();
  for (int i = 0; i < 100; ++i) log("nobody reads this");
}

TEST_F(LineLogTest, LogContinuesAfterAFullDiskAndReportsLoss) {
  LineLog log(path);
  log("before");
  ASSERT_TRUE(comes("before\n"));
  // Forbids files to grow, as if the disk were full.
  signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  rlimit less = limit;
  less.rlim_cur = static_cast<rlim_t>(fs::file_size(path));
  setrlimit(RLIMIT_FSIZE, &less);
  const std::string line(1000, 'x');
  const int kLines = 3 * static_cast<int>(LineLog::kMaxWaiting / line.size());
  for (int i = 0; i < kLines; ++i) log(line);
  // Keep the disk full until the writer has tried to write.
  EXPECT_TRUE(hasFailedToWrite());
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_TRUE(comes(" log lines were lost: the log could not be written (File too large)"));
  log("after");
  EXPECT_TRUE(comes(" after\n"));
}

TEST_F(LineLogTest, ThreadlessLogDropsAndCountsInsteadOfBlocking) {
  StderrPipe pipe;
  LineLog log("", LineLog::Writer::kCaller);
  const std::string line(1500, 'x');
  for (int i = 0; i < 100; ++i) log(line);
  const std::string kept = pipe.readUntil("x\n");
  EXPECT_EQ(kept.front(), 'x') << "the time is the front's to add";
  log("it goes on");
  const std::string said = pipe.readUntil("it goes on");
  EXPECT_EQ(linesLost(said), 100 - std::count(kept.begin(), kept.end(), '\n')) << said;
}

TEST_F(LineLogTest, ReopensItsFileOnRequest) {
  LineLog log(path);
  log("first");
  ASSERT_TRUE(comes("first\n"));
  fs::rename(path, base / "log.1");
  LineLog::reopenAll();
  log("second");
  ASSERT_TRUE(comes("second\n"));
  EXPECT_EQ(read().find("first"), std::string::npos);
}

TEST_F(LineLogTest, RotationsLoseNoLine) {
  constexpr int kFiles = 20;
  constexpr int kLines = 200;  // per file
  std::string all;
  {
    LineLog log(path);
    for (int file = 0; file < kFiles; ++file) {
      for (int i = 0; i < kLines; ++i) log("line " + std::to_string(file * kLines + i) + ";");
      ASSERT_TRUE(comes(";"));  // the file is open now
      fs::rename(path, base / ("log." + std::to_string(file)));
      LineLog::reopenAll();
    }
    log("end");
    ASSERT_TRUE(comes("end"));
  }
  for (int file = 0; file < kFiles; ++file) all += test::contentOf(base / ("log." + std::to_string(file)));
  all += read();
  std::size_t at = 0;
  for (int i = 0; i < kFiles * kLines && at != std::string::npos; ++i)
    at = all.find("line " + std::to_string(i) + ";", at);
  EXPECT_NE(at, std::string::npos) << "each of them, in order";
}

TEST_F(LineLogTest, APipeOrAFolderIsRefused) {
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_THROW(LineLog(path.string()), std::runtime_error);
  EXPECT_THROW(LineLog(base.string()), std::runtime_error);
  EXPECT_THROW(LineLog((base / "none" / "log").string()), std::runtime_error);
}

TEST_F(LineLogTest, OneCallWritesOneLine) {
  LineLog log(path);
  log("one\n2025-01-01 00:00:00 two\x1b[31m\r\xc2\x9b");
  ASSERT_TRUE(comes("one\\n2025-01-01 00:00:00 two\\x1b[31m\\x0d\\x9b\n")) << read();
  log(std::string(100'000, 'y') + "z");
  log("end");
  ASSERT_TRUE(comes("end\n"));
  const std::string all = read();
  EXPECT_LT(all.size(), 3 * LineLog::kMaxLine);
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 3);
}

TEST(LogText, QuotesEscapeTheirContent) {
  EXPECT_EQ(inQuotes("Ann"), "\"Ann\"");
  EXPECT_EQ(inQuotes("a\" left"), R"("a\" left")");
  EXPECT_EQ(inQuotes("a\\"), R"("a\\")");
  EXPECT_EQ(inQuotes("a\nb\x7f"), R"("a\nb\x7f")");
  EXPECT_EQ(inQuotes("\xc3\xa9\xe2\x82\xac"), "\"\xc3\xa9\xe2\x82\xac\"") << "other characters stay";
}

using Json = nlohmann::json;

constexpr std::size_t kMost = 2048;
const std::chrono::system_clock::time_point kTime{std::chrono::milliseconds(1'769'860'799'007)};

std::string jsonLine(const LogEvent& event, std::size_t most = kMost) {
  return formatEvent(event, LogFormat::kJson, kTime, most);
}

Json parse(const LogEvent& event, std::size_t most = kMost) {
  return Json::parse(jsonLine(event, most));
}

TEST(LogFormatTest, EventIsFormattedAsText) {
  const LogEvent event{"joined", "192.0.2.1:4000 \"Ann\" joined", {{"player", "Ann"}}};
  EXPECT_EQ(formatEvent(event, LogFormat::kBare, kTime, kMost), "192.0.2.1:4000 \"Ann\" joined\n");
  const std::string line = formatEvent(event, LogFormat::kText, kTime, kMost);
  EXPECT_EQ(line.substr(std::string("2026-01-31 11:59:59").size()), " 192.0.2.1:4000 \"Ann\" joined\n");
}

TEST(LogFormatTest, EventIsFormattedAsJsonWithItsFields) {
  EXPECT_EQ(jsonLine({"joined", "192.0.2.1:4000 \"Ann\" joined", {{"address", "192.0.2.1:4000"}}}),
            R"({"time":"2026-01-31T11:59:59.007Z","level":"info","event":"joined",)"
            R"("text":"192.0.2.1:4000 \"Ann\" joined","address":"192.0.2.1:4000"})"
            "\n");
  EXPECT_EQ(parse("a text").at("event"), "note");
  EXPECT_EQ(parse({LogEvent::Level::kWarning, "warning: x"}).at("level"), "warning");
}

TEST(LogFormatTest, AnyBytesGiveOneLineOfValidJson) {
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
  const std::string line = jsonLine({"chat", all, {{"line", all}, {"player", "\"},{\"event\":\"joined"}}});
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const Json object = Json::parse(line);
  EXPECT_EQ(object.at("event"), "chat");
  EXPECT_EQ(object.at("player"), "\"},{\"event\":\"joined");
  for (const char c : object.at("text").get<std::string>()) EXPECT_GE(static_cast<unsigned char>(c), 0x20);
}

TEST(LogFormatTest, LongLineIsTruncatedButStaysValidJson) {
  for (const std::string& piece : {std::string("x"), std::string("\""), std::string("\xe2\x82\xac")}) {
    std::string text;
    while (text.size() < 10'000) text += piece;
    const LogEvent event{"chat", text, {{"line", text}}};
    EXPECT_LE(jsonLine(event).size(), kMost);
    EXPECT_EQ(parse(event).at("event"), "chat");
    EXPECT_FALSE(parse(event).at("text").get<std::string>().empty());
    EXPECT_EQ(formatEvent(event, LogFormat::kText, kTime, kMost).size(), kMost);
  }
}

}  // namespace
}  // namespace naiad
