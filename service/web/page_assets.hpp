#pragma once

#include <span>
#include <string_view>

namespace telltale {

/// A file of the page, compiled into the daemon.
struct PageAsset {
  std::string_view path;  ///< "/index.html"
  std::string_view type;  ///< "text/html; charset=utf-8"
  std::string_view body;
};

/// None where the daemon is built without the page.
std::span<const PageAsset> PageAssets();

}  // namespace telltale
