// Completes the rounds of a killed server: appends to their files the records that waited in
// shared memory, and removes them there.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace naiad {

/// Completes the files of this folder whose servers are gone, so that they have every turn that a world got.
/// Other files, and rounds that are being played, are left alone. Returns a line for the log for each
/// completed file, except for the rounds `left` (uuids), whose servers were not killed.
std::vector<std::string> salvageRounds(const std::string& folder, const std::set<std::string>& left = {});

}  // namespace naiad
