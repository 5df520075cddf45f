// Where Seeds.cpp and WorldSeeds.cpp put what they make.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "shared/values/SplitMix64.h"

namespace naiad::fuzz {

/// Where the seeds of one target go. Throws std::filesystem::filesystem_error.
class Folder {
 public:
  explicit Folder(std::filesystem::path path, std::string prefix = "seed-")
      : m_path(std::move(path)), m_prefix(std::move(prefix)) {
    std::filesystem::create_directories(m_path);
  }
  void add(const std::string& bytes) {
    std::ofstream(m_path / (m_prefix + std::to_string(++m_count)), std::ios::binary) << bytes;
  }

 private:
  std::filesystem::path m_path;
  std::string m_prefix;
  int m_count = 0;
};

/// In two bytes, the lower one first.
inline std::string u16(std::size_t value) {
  return {static_cast<char>(value & 0xFF), static_cast<char>(value >> 8)};
}

inline std::string randomBytes(SplitMix64& random, std::size_t count) {
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random.next());
  return bytes;
}

}  // namespace naiad::fuzz
