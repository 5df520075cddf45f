// The log files of this process, for worlds that have no sink of their own.
#pragma once

#include <string>

namespace df {

/// Appends a line to the file, which is created with mode 0640; the first call for a name empties it. Never
/// waits: if the file cannot be opened, the disk is full or a pipe is not read, the line is dropped, and
/// later lines are tried again. Other processes may append to the file too. Any thread.
void writeToLogFile(const std::string& filename, const std::string& line, bool flush);

/// Makes writeToLogFile() empty no files, because another process of this game writes to them. Any thread.
void disableLogTruncation();

/// Appends a line to another file, which this process's first line empties. Returns false on failure. Any
/// thread.
bool writeToFile(const std::string& filename, const std::string& line);

}  // namespace df
