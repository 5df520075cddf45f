// Chooses the files, variables and memory that the worlds of a server get (host/world/Sandbox.h).
//
// A game reads its own folder and those of its resources, and writes into the working directory. A folder
// that is too wide (the user's home, or one with the server's key) is not given as a whole: a game gets only
// sprites/ and sounds/ in it. A working directory with files of the running program is readable, but not
// writable, unless that program is the game.
#pragma once

#include <string>
#include <vector>

#include "host/settings/HostOptions.h"
#include "host/world/Sandbox.h"

namespace naiad {

/// Paths of a game's files. Relative paths refer to the directory in which the program was started.
struct GamePaths {
  std::vector<std::string> files;         ///< the game's module and settings
  std::vector<std::string> folders;       ///< the game's resources
  std::vector<std::string> logs;          ///< files that the game appends to
  std::vector<std::string> server_files;  ///< written by the server: no world should write them
  std::vector<std::string> secrets;       ///< files or folders, in addition to those of the options
  bool is_program = false;  ///< the front's program is the game itself: a world may write into its folder
};

struct SandboxPolicy {
  Sandbox sandbox;
  std::vector<std::string>
      notes;  ///< lines for the log: restrictions of the game, and files that it could change
};

SandboxPolicy makeSandboxPolicy(const HostOptions& options, const GamePaths& place);

/// Returns the variables that a world gets from this process's environment: a fixed choice, and those that
/// HostOptions::world_environment names. Never returns the passwords.
std::vector<std::string> makeWorldEnvironment(const HostOptions& options);

/// Like makeWorldEnvironment(), for worlds whose rounds are recorded: variables that depend on the user who
/// started the server are removed or fixed, unless the options name them.
std::vector<std::string> makeFixedEnvironment(const HostOptions& options);

/// True for "NAME=value" of a variable that changes the behaviour of games, so that round files record it.
bool isGameVariable(const std::string& entry);

/// Overwrites the values of --password and --admin-password, because every process can read a command line.
void hidePassword(int argc, char** argv);
/// Returns the words of a command line without its passwords, for a program that this one runs.
std::vector<std::string> withoutPasswords(const std::vector<std::string>& words);

/// Returns the file of --config; empty if there is none.
std::string configFileOf(int argc, const char* const* argv);

}  // namespace naiad
