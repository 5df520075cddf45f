// What the process of a world may do. It runs a game, which is somebody's program, under this user's id:
// permissions of files keep nothing from it, so the kernel is asked to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// What a world gets. Libraries and programs of the system are readable without being listed here.
struct Sandbox {
  bool on = true;
  // Files, or folders with all that is in them; those that are not there are left out.
  std::vector<std::string> readable;    ///< and executable
  std::vector<std::string> writable;    ///< readable, too
  std::vector<std::string> appendable;  ///< files that are made if they are not there
  std::uint64_t memory = 0;             ///< bytes of address space; 0: no limit. None with a sanitizer
};

/// What this kernel has, and lets us use.
struct SandboxSupport {
  std::int32_t landlock = 0;   ///< version; 0: none
  std::int32_t filter = 0;     ///< 1: seccomp
  std::int32_t addresses = 0;  ///< 1: they can be fixed (FixedStart.h)
};

/// Try it out, in processes that end then. For a process without threads.
SandboxSupport findSandboxSupport();

/// A sentence for the log if something is missing; else empty.
std::string sandboxGaps(const SandboxSupport& support);

/// Enter it, for good; for a process without threads that is about to execute a program. Return errno, or 0.
/// Whoever gets an error must not go on.
int enterSandbox(const Sandbox& sandbox, const SandboxSupport& support);

/// This process's memory, environment and descriptors are nobody's but root's: not those of its worlds. Its
/// core is not dumped then. Nothing with a sanitizer, which traces its own process.
void hideProcess();

/// Folders of the system that every world may read.
const std::vector<std::string>& systemFolders();

}  // namespace naiad
