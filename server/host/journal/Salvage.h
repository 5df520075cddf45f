// Rounds of a server that was killed: what waited for the disk in shared memory is put into their files.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace naiad {

/// Complete the files of this folder whose servers are gone, so that they have every turn that a world got.
/// Other files, and rounds that are being played, are left alone. Return a sentence for the log for each but
/// those of `left`, by uuid, which no server was killed in.
std::vector<std::string> salvageRounds(const std::string& folder, const std::set<std::string>& left = {});

}  // namespace naiad
