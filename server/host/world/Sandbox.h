// Restricts the process of a world. A game may be anyone's program and runs under this user's id, so file
// permissions do not restrain it. The kernel's sandboxes do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace naiad {

/// Permissions of a world. Libraries and programs of the system are always readable.
struct Sandbox {
  bool on = true;
  // Files, or folders with all their content. Missing ones are ignored, except in `appendable`.
  std::vector<std::string> readable;    ///< readable and executable
  std::vector<std::string> writable;    ///< readable, executable and writable
  std::vector<std::string> appendable;  ///< files only: writable, not readable; created if missing
  std::uint64_t memory = 0;  ///< limit of the address space in bytes; 0, or with a sanitizer: no limit
};

/// Kernel features that this process may use.
struct SandboxSupport {
  std::int32_t landlock = 0;   ///< version of Landlock; 0: none
  std::int32_t filter = 0;     ///< 1: system calls can be filtered (seccomp)
  std::int32_t addresses = 0;  ///< 1: addresses can be fixed (FixedAddresses.h)
};

/// Tries out all features but `addresses`, in short-lived processes. For a process without threads.
SandboxSupport findSandboxSupport();

/// Returns a sentence for the log if Landlock or the filter is missing; otherwise empty.
std::string missingSandboxFeatures(const SandboxSupport& support);

/// Enters the sandbox, permanently. For a process without threads that is about to execute a program. Returns
/// errno, or 0; after an error the process must not continue.
int enterSandbox(const Sandbox& sandbox, const SandboxSupport& support);

/// Hides this process's memory, environment and descriptors from its worlds, because only root can read them
/// afterwards. The process also dumps no core. Does nothing with a sanitizer, which traces its own process.
void makeUndumpable();

/// Returns the system folders that every world may read.
const std::vector<std::string>& systemFolders();

}  // namespace naiad
