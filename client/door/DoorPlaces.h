// How many visitors a door has at a time, in all and from one place: one locked file for each, in a folder. A
// process that ends, however it ends, gives its place back.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace naiad {

/// A place, held while it lives. Children do not hold it.
class DoorPlace {
 public:
  struct Limits {
    int in_all = 64;
    int per_prefix = 8;  ///< of these, from one IPv4 address or IPv6 /64
  };
  enum class Refusal { kNone, kFull, kFullForPrefix };
  struct Taken {
    std::unique_ptr<DoorPlace> place;  ///< null: refused
    Refusal refusal = Refusal::kNone;
  };

  /// Take one for a visitor at this address, "192.0.2.7:50312" or "[2001:db8::7]:50312". The folder is made
  /// if it is missing, 0700. Waits for other processes that take one in it at the same time, which is short.
  /// Throws std::system_error.
  static Taken take(const std::filesystem::path& folder, const std::string& visitor, const Limits& limits);

  ~DoorPlace();
  DoorPlace(const DoorPlace&) = delete;
  DoorPlace& operator=(const DoorPlace&) = delete;

 private:
  explicit DoorPlace(int file) : m_file(file) {}
  int m_file;
};

}  // namespace naiad
