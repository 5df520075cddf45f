// Where a journal's bytes go: a file, or in tests a disk that stalls or is full.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace naiad {

/// Each call may wait for as long as the disk does, and throws std::system_error. On the writer's thread.
class JournalSink {
 public:
  virtual ~JournalSink() = default;
  /// Append.
  virtual void write(std::string_view bytes) = 0;
  /// What was written survives a power cut.
  virtual void sync() = 0;
  /// Replace the header's flags.
  virtual void setFlags(std::uint16_t flags) = 0;
};

/// A longer file is neither written nor read: some 270 hours of four players, a month of none.
inline constexpr std::size_t kMaxRoundFile = std::size_t{128} << 20;

/// Remove the oldest rounds of a folder until it has no more than these. One that a server is writing stays.
void removeOldRounds(const std::string& folder, std::size_t max_files, std::uintmax_t max_bytes);

/// A new file, readable by this user alone. It is made by the first write; its folder, too, if its parent is
/// there. The file is locked for as long as this is. More than kMaxRoundFile is an error, EFBIG.
class JournalFileSink : public JournalSink {
 public:
  explicit JournalFileSink(std::string path) : m_path(std::move(path)) {}
  /// Goes on with a file that is there, behind its first `size` bytes; what is behind them is cut off. Throws
  /// std::system_error, with EWOULDBLOCK if another server writes it.
  JournalFileSink(std::string path, std::size_t size);
  ~JournalFileSink() override;
  JournalFileSink(const JournalFileSink&) = delete;
  JournalFileSink& operator=(const JournalFileSink&) = delete;

  void write(std::string_view bytes) override;
  void sync() override;
  void setFlags(std::uint16_t flags) override;

  /// Files of one folder, and bytes of all of them, at most: of more, the oldest go when another is made.
  static constexpr std::size_t kMaxFiles = 200;
  static constexpr std::uintmax_t kMaxFolder = std::uintmax_t{1} << 30;

 private:
  void open();

  std::string m_path;
  std::size_t m_size = 0;  ///< of the file
  int m_file = -1;
};

}  // namespace naiad
