// A text as a QR code of characters, for phones that scan a terminal.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// Returns lines of half blocks, two modules high, with the quiet zone of four modules that ISO/IEC 18004
/// requires. Light modules are drawn and dark ones are not, for dark terminals; phones also read the inverse.
/// Empty if this program was built without libqrencode, or the text is too long (about 2,900 bytes).
std::vector<std::string> qrCode(const std::string& text);

}  // namespace naiad
