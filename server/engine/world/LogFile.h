// The log files of this process, for worlds that have no sink of their own.
#pragma once

#include <string>

namespace df {

/// Appends a line to the file. The first call for a name empties the file, or creates it with mode 0640.
/// Never waits: drops the line if the file cannot be opened, the disk is full or a pipe is not read; later
/// lines are tried again. Other processes may append to the file, too. Any thread may call it.
void writeToLogFile(const std::string& filename, const std::string& line, bool flush);

/// Makes writeToLogFile() empty no files: another process of this game uses them. Any thread may call it.
void disableLogTruncation();

/// Appends a line to a file of the game's own; the process's first line empties the file. Returns false on
/// failure. Any thread may call it.
bool writeToFile(const std::string& filename, const std::string& line);

}  // namespace df
