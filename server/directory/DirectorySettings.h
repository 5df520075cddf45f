// What a directory is given, beside its log.
#pragma once

#include <string>

#include "host/fleet/Bus.h"

namespace naiad {

struct DirectorySettings {
  BusSettings bus;
  std::string list;  ///< file for the list of servers; empty: none
};

}  // namespace naiad
