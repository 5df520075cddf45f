// What the codec of the wire prints.
#pragma once

namespace naiad {

/// The codec prints nothing from now on. The protobuf library reports malformed text on stderr, so that a
/// peer could write on a player's screen or fill a host's log; parsing returns false as well, which is
/// enough. To be called before the first message is parsed; cheap to call again, from any thread.
void silenceParseErrors();

}  // namespace naiad
