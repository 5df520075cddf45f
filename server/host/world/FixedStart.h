// What a process needs for its addresses to be the same each time, beside the kernel's leave not to randomise
// them: where the stack begins depends on how long its arguments and environment are, and where libraries lie
// on the limit of the stack.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// Bring arguments and environment to a fixed number together and, with the program, to a fixed number of
/// bytes.
void padEnvironment(const std::string& program, const std::vector<std::string>& arguments,
                    std::vector<std::string>& environment);

/// Would fixAddresses() do? Tried in a process that ends then.
bool canFixAddresses();

/// Are those of this process?
bool hasFixedAddresses();

/// For this process, which is about to execute a program: the same addresses each time. False: this kernel,
/// or whoever has started the server, does not let it.
bool fixAddresses();

}  // namespace naiad
