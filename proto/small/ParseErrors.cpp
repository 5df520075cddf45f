#include "proto/ParseErrors.h"

namespace naiad {

// This codec prints nothing.
void silenceParseErrors() {}

}  // namespace naiad
