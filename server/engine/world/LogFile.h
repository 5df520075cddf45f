// The log files of this process, for worlds that have no sink of their own.
#pragma once

#include <string>

namespace df {

/// Append a line to the file (made with mode 0640); the first call for a name opens and empties it. Where
/// that cannot be done, the line is dropped; so it is by a full disk, and by a pipe that is not read. Nothing
/// is waited for, and later lines are tried again. Others may append to it meanwhile. Any thread.
void writeToLogFile(const std::string& filename, const std::string& line, bool flush);

/// From now on writeToLogFile() empties none: another process of this game writes to them, too. Any thread.
void keepLogFiles();

/// Append a line to another file; its first line of this process empties it. Return false if that cannot be
/// done. Any thread.
bool writeToFile(const std::string& filename, const std::string& line);

}  // namespace df
