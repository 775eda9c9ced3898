#pragma once

#include <cstddef>
#include <string>

namespace telltale {

/// Where the log of a daemon says that its page is: "http://127.0.0.1:8480".
inline std::string PageOf(const std::string& log) {
  const std::size_t begin = log.find("http://127.0.0.1:");
  return log.substr(begin, log.find('/', begin + std::string("http://").size()) - begin);
}

}  // namespace telltale
