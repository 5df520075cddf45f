// Rounds of a server that was killed: what waited for the disk in shared memory is put into their files.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// Complete the files of this folder whose servers are gone, so that they have every turn that a world got.
/// Other files, and rounds that are being played, are left alone. Return a sentence for the log for each.
std::vector<std::string> salvageRounds(const std::string& folder);

}  // namespace naiad
