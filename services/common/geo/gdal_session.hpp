// Captures GDAL's errors for exception texts. By default GDAL prints them on stderr.
#pragma once

#include <cpl_conv.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace rover {

class GdalSession {
 public:
  GdalSession() {
    GDALAllRegister();
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~GdalSession() { CPLPopErrorHandler(); }
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  bool failed() const { return CPLGetLastErrorType() >= CE_Failure; }
  // On one line of a readable length, in brackets; empty if there was none.
  std::string last_error() const {
    constexpr size_t kMaxLength = 500;
    std::string text = CPLGetLastErrorMsg();
    if (text.size() > kMaxLength) text.replace(kMaxLength, std::string::npos, " ...");
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return text.empty() ? "" : " (" + text + ")";
  }
};

}  // namespace rover
