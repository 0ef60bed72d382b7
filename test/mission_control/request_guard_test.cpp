// Request authorisation by Host, Origin and token.
#include "mission_control/request_guard.hpp"

#include <gtest/gtest.h>

namespace rover::mission {
namespace {

const GuardConfig kLocal{"127.0.0.1", 8080, ""};
const GuardConfig kRemote{"192.168.1.5", 8080, "0123456789abcdef"};

RequestFacts own_command() {
  return {"POST", "127.0.0.1:8080", "http://127.0.0.1:8080", "same-origin", "application/json", ""};
}

TEST(RequestGuard, AcceptsSameOriginCommand) {
  EXPECT_EQ(check_request(kLocal, own_command()).status, 200);
  RequestFacts old_browser = own_command();
  old_browser.fetch_site = "";
  EXPECT_EQ(check_request(kLocal, old_browser).status, 200);
  RequestFacts by_name = own_command();
  by_name.host = "localhost:8080";
  by_name.origin = "http://localhost:8080";
  EXPECT_EQ(check_request(kLocal, by_name).status, 200);
}

TEST(RequestGuard, RefusesCrossSiteCommand) {
  for (const char* origin : {"", "null", "http://evil.example", "https://127.0.0.1:8080", "http://127.0.0.1:8081",
                             "http://127.0.0.1:8080.evil.example"}) {
    RequestFacts request = own_command();
    request.origin = origin;
    EXPECT_EQ(check_request(kLocal, request).status, 403) << origin;
  }
  for (const char* site : {"cross-site", "same-site", "none"}) {
    RequestFacts request = own_command();
    request.fetch_site = site;
    EXPECT_EQ(check_request(kLocal, request).status, 403) << site;
  }
}

// DNS rebinding: a foreign Host with a matching Origin.
TEST(RequestGuard, RefusesDnsRebinding) {
  for (const char* host : {"", "evil.example:8080", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:8080.evil.example"}) {
    RequestFacts request = own_command();
    request.host = host;
    request.origin = std::string("http://") + host;
    EXPECT_EQ(check_request(kLocal, request).status, 403) << host;
    request.method = "GET";
    EXPECT_EQ(check_request(kLocal, request).status, 403) << host;
  }
}

// Content types that a cross-site form can send without a preflight.
TEST(RequestGuard, RefusesOtherContentTypes) {
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data"}) {
    RequestFacts request = own_command();
    request.content_type = type;
    EXPECT_EQ(check_request(kLocal, request).status, 415) << type;
  }
}

TEST(RequestGuard, RefusesOtherMethods) {
  for (const char* method : {"HEAD", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", ""}) {
    RequestFacts request = own_command();
    request.method = method;
    EXPECT_EQ(check_request(kLocal, request).status, 405) << method;
  }
}

TEST(RequestGuard, NonLoopbackAddressNeedsTokenForEverything) {
  RequestFacts request{"GET", "rover.local:8080", "", "", "", ""};
  EXPECT_EQ(check_request(kRemote, request).status, 401);
  request.token = "0123456789abcdeg";
  EXPECT_EQ(check_request(kRemote, request).status, 401);
  request.token = "0123456789abcdef0";
  EXPECT_EQ(check_request(kRemote, request).status, 401);
  request.token = kRemote.token;
  EXPECT_EQ(check_request(kRemote, request).status, 200);
  RequestFacts command{"POST", "rover.local:8080", "http://evil.example", "", "application/json", kRemote.token};
  EXPECT_EQ(check_request(kRemote, command).status, 403);
  command.origin = "http://rover.local:8080";
  EXPECT_EQ(check_request(kRemote, command).status, 200);
}

TEST(RequestGuard, ComparesWholeSecret) {
  EXPECT_TRUE(same_secret("abc", "abc"));
  for (const char* other : {"", "ab", "abcd", "abd", "ABC"}) EXPECT_FALSE(same_secret(other, "abc")) << other;
}

TEST(RequestGuard, FindsCookieByWholeName) {
  EXPECT_EQ(cookie("a=1; rover_token=xyz; b=2", "rover_token"), "xyz");
  EXPECT_EQ(cookie("not_rover_token=1", "rover_token"), "");
  EXPECT_EQ(cookie("rover_token=", "rover_token"), "");
  EXPECT_EQ(cookie("", "rover_token"), "");
  EXPECT_EQ(cookie(";;;= ;", "rover_token"), "");
}

TEST(RequestGuard, RecognisesLoopback) {
  EXPECT_TRUE(is_loopback("127.0.0.1") && is_loopback("localhost") && is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0") || is_loopback("192.168.1.5") || is_loopback("127.0.0.1.evil.example"));
}

}  // namespace
}  // namespace rover::mission
