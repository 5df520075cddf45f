// Gives a process equal addresses in each run. Without randomisation they still depend on two sizes: the
// start of the stack on the size of arguments and environment, and that of libraries on the stack's limit.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// Pads the environment, so that it and the arguments together have a multiple of 64 entries and, with the
/// program's path, a multiple of 16 KiB.
void padEnvironment(const std::string& program, const std::vector<std::string>& arguments,
                    std::vector<std::string>& environment);

/// True if disableAslr() works. Tries it in a process that then ends.
bool canDisableAslr();

/// True if address randomisation is off in this process.
bool hasFixedAddresses();

/// Fixes the addresses of the program that this process is about to execute. Returns false if the kernel, or
/// a filter that the server was started with, does not allow it.
bool disableAslr();

}  // namespace naiad
