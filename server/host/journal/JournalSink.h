// The destination of a journal's bytes: a file, or in tests a disk that stalls or is full.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace naiad {

/// Called on the writer's thread; may block as long as the disk does. Throws std::system_error on failure.
class JournalSink {
 public:
  virtual ~JournalSink() = default;
  /// Appends bytes.
  virtual void write(std::string_view bytes) = 0;
  /// Makes all bytes written so far survive a power cut.
  virtual void sync() = 0;
  /// Overwrites the header's flags.
  virtual void setFlags(std::uint16_t flags) = 0;
};

/// Maximum size of a file, written or read: about 270 hours with four players, a month without any.
inline constexpr std::size_t kMaxRoundFile = std::size_t{128} << 20;

/// Removes the oldest rounds of a folder until it is within both limits. Files that a server is writing stay.
void removeOldRounds(const std::string& folder, std::size_t max_files, std::uintmax_t max_bytes);

/// A new file, readable by this user only and locked until this object is destroyed. The first write creates
/// it, and its folder if the parent exists. A file longer than kMaxRoundFile is an error, EFBIG.
class JournalFileSink : public JournalSink {
 public:
  explicit JournalFileSink(std::string path) : m_path(std::move(path)) {}
  /// Appends to an existing file after its first `size` bytes; the rest is truncated. Throws
  /// std::system_error, with EWOULDBLOCK if another server is writing the file.
  JournalFileSink(std::string path, std::size_t size);
  ~JournalFileSink() override;
  JournalFileSink(const JournalFileSink&) = delete;
  JournalFileSink& operator=(const JournalFileSink&) = delete;

  void write(std::string_view bytes) override;
  void sync() override;
  void setFlags(std::uint16_t flags) override;

  /// Limits of one folder, in files and bytes. The creation of a file removes the oldest ones beyond them.
  static constexpr std::size_t kMaxFiles = 200;
  static constexpr std::uintmax_t kMaxFolder = std::uintmax_t{1} << 30;

 private:
  void open();

  std::string m_path;
  std::size_t m_size = 0;  ///< size of the file, in bytes
  int m_file = -1;
};

}  // namespace naiad
