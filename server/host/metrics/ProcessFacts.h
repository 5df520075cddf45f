// What the kernel says of this process, as every exporter of Prometheus gives it out (process_…).
#pragma once

#include <cstdint>
#include <string>

namespace naiad {

class Exposition;

struct ProcessFacts {
  double cpu_seconds = 0;      ///< of all its threads, in the program and in the kernel
  double start_seconds = 0;    ///< since 1970
  std::uint64_t resident = 0;  ///< bytes
  std::uint64_t virtual_size = 0;
  std::uint64_t open_files = 0;
  std::uint64_t max_files = 0;

  /// Reads /proc; what cannot be read is 0.
  static ProcessFacts read();
};

void writeProcess(Exposition& out, const ProcessFacts& facts);

}  // namespace naiad
