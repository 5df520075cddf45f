// Landlock: the files that a world's process may open, and nothing else of the file system.
//
// The kernel's interface is used directly, by numbers: the headers of a machine may be older than its kernel.
#pragma once

#include <cstdint>
#include <string>

namespace naiad {

/// The version of Landlock's interface that this kernel has; 0: none. 3 holds back truncate(), 6 signals to
/// others.
int landlockVersion();
inline constexpr int kLandlockHoldsTruncation = 3;
inline constexpr int kLandlockScopesSignals = 6;

class LandlockRules {
 public:
  /// Nothing is allowed. `version`: of landlockVersion(), above 0.
  explicit LandlockRules(int version);
  ~LandlockRules();
  LandlockRules(const LandlockRules&) = delete;
  LandlockRules& operator=(const LandlockRules&) = delete;

  // A file, or a folder with all that is in it. One that is not there, or cannot be reached, is left out.

  /// To read, list and execute.
  void allowReading(const std::string& path);
  /// The same, and to write, make and remove files and folders there; no links, devices or sockets.
  void allowWriting(const std::string& path);
  /// To write into a file that is there.
  void allowAppending(const std::string& path);
  /// A device file.
  void allowDevice(const std::string& path);

  /// Make them hold, for this thread and all that it starts, for good. PR_SET_NO_NEW_PRIVS has been called.
  /// Return errno, or 0.
  int enforce();

 private:
  void allow(const std::string& path, std::uint64_t access) const;

  std::uint64_t m_handled = 0;  ///< what is refused unless a rule allows it
  int m_rules = -1;
  int m_error = 0;
};

}  // namespace naiad
