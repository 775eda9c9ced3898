#pragma once

#include <string_view>

namespace telltale {

/// The style sheet of a page: fonts of the reader's system, light and dark, colours that stay apart
/// for colour-blind eyes (Okabe and Ito's vermilion and blue).
std::string_view Style();

}  // namespace telltale
