// The page over HTTP: what it serves, whom, and what becomes of commands.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "test/mission_control/page_under_test.hpp"
#include "test/wild.hpp"

namespace rover::mission::test {
namespace {

using nlohmann::json;

json json_of(const std::string& answer) {
  return json::parse(body_of(answer), nullptr, false);
}

// The first bytes of a stream of views.
std::string open_stream(int port, const std::string& query, int& fd) {
  fd = connect_to(port);
  const std::string request =
      "GET /api/stream" + query + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n";
  EXPECT_EQ(send(fd, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
  std::string got;
  char buffer[4096];
  while (got.find("\n\n") == std::string::npos) {
    const ssize_t n = recv(fd, buffer, sizeof buffer, 0);
    if (n <= 0) break;
    got.append(buffer, static_cast<size_t>(n));
  }
  return got;
}

TEST(Page, ServesItsFilesAndTheLibrariesFromThisMachine) {
  TestServer server;
  for (const char* path :
       {"/",           "/style.css",   "/app.js",         "/map.js",         "/panels.js",       "/charts.js",
        "/camera.js",  "/commands.js", "/icon.svg",       "/lib/leaflet.js", "/lib/leaflet.css", "/lib/chart.js",
        "/map/relief", "/map/slope",   "/map/difficulty", "/api/setup",      "/api/history",     "/api/events",
        "/api/paths",  "/api/camera"}) {
    const std::string answer = get(server.port(), path);
    EXPECT_EQ(status_of(answer), 200) << path;
    EXPECT_GT(body_of(answer).size(), 1U) << path;
  }
  const std::string page = body_of(get(server.port(), "/"));
  EXPECT_EQ(page.find("http://"), std::string::npos);
  EXPECT_EQ(page.find("https://"), std::string::npos);
}

TEST(Page, ForbidsFramesAndForeignSources) {
  TestServer server;
  const std::string answer = get(server.port(), "/");
  EXPECT_NE(answer.find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_NE(answer.find("default-src 'self'"), std::string::npos);
  EXPECT_EQ(answer.find("Access-Control-Allow-Origin"), std::string::npos);
}

TEST(Page, WhatIsNotThereIs404) {
  TestServer server;
  for (const char* path : {"/nothing", "/lib/../../etc/passwd", "/../etc/passwd", "/lib/%2e%2e/%2e%2e/etc/passwd",
                           "/layer/hazards.png", "/layer/truth.png", "/camera/loccam.jpg"})
    EXPECT_EQ(status_of(get(server.port(), path)), 404) << path;
}

TEST(Page, ACommandIsGivenOnceAndItsAnswerComesBack) {
  TestServer server;
  const std::string answer = post(server.port(), "/api/command", R"({"command":"go"})");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(json_of(answer)["accepted"], true);
  ASSERT_EQ(server.taken().size(), 1U);
  EXPECT_EQ(server.taken()[0].kind, CommandKind::kGo);
}

TEST(Page, BadRequestsAre4xxAndGiveNothing) {
  TestServer server;
  const std::string own = "127.0.0.1:" + std::to_string(server.port());
  const auto raw = [&](const std::string& head, const std::string& body) {
    return status_of(talk(server.port(), head + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body));
  };
  const std::string go = R"({"command":"go"})";
  const std::string host = "POST /api/command HTTP/1.1\r\nConnection: close\r\nHost: " + own + "\r\n";
  const std::string json_type = "Content-Type: application/json\r\n";
  const std::string origin = "Origin: http://" + own + "\r\n";
  EXPECT_EQ(raw(host + json_type, go), 403) << "without origin";
  EXPECT_EQ(raw(host + json_type + "Origin: http://evil.example\r\n", go), 403);
  EXPECT_EQ(raw(host + json_type + origin + "Sec-Fetch-Site: cross-site\r\n", go), 403);
  EXPECT_EQ(raw(host + origin + "Content-Type: text/plain\r\n", go), 415);
  EXPECT_EQ(
      raw("POST /api/command HTTP/1.1\r\nConnection: close\r\nHost: evil.example\r\nOrigin: http://evil.example\r\n" +
              json_type,
          go),
      403);
  EXPECT_EQ(raw("PUT /api/command HTTP/1.1\r\nConnection: close\r\nHost: " + own + "\r\n" + json_type + origin, go),
            405);
  EXPECT_EQ(status_of(post(server.port(), "/api/command", "{")), 400);
  EXPECT_EQ(status_of(post(server.port(), "/api/command", R"({"command":"fly"})")), 400);
  EXPECT_EQ(status_of(post(server.port(), "/api/command", std::string(70'000, ' ') + go)), 413);
  EXPECT_EQ(status_of(post(server.port(), "/api/other", go)), 404);
  EXPECT_EQ(status_of(get(server.port(), "/api/command")), 404);
  EXPECT_EQ(status_of(get(server.port(), "/" + std::string(10'000, 'a'))), 414);
  EXPECT_TRUE(server.taken().empty());
}

TEST(Page, GetAndPostAreTheOnlyMethods) {
  TestServer server;
  const std::string host = " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) + "\r\n";
  const std::map<std::string, std::string> before = {
      {"HEAD", "200"}, {"OPTIONS", "405"}, {"TRACE", "405"}, {"BREW", "400"}};
  for (const auto& [method, status_before] : before) {
    const std::string answer = talk(server.port(), method + " /" + host + "\r\n");
    EXPECT_EQ(status_of(answer), 405) << method;
    EXPECT_NE(answer.find("\r\nAllow: GET, POST\r\n"), std::string::npos) << method;
    wild_row("The page's server", method + " /", status_before, body_of(answer));
  }
}

// No part of an answer is ever sent, so many parts cannot multiply it.
TEST(Page, RangesAreIgnored) {
  TestServer server;
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 1000; ++i) ranges += ",0-";
  const std::string answer =
      talk(server.port(), "GET /map/relief HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) + "\r\n" +
                              ranges + "\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(body_of(answer), body_of(get(server.port(), "/map/relief")));
  wild_row("The page's server", "1000 overlapping ranges (cpp-httplib 1766)", "400", "200, the whole picture once");
}

TEST(Page, PathsAreCheckedAgainstTheMap) {
  TestServer server;
  const auto send_path = [&](const char* points) {
    return status_of(post(server.port(), "/api/command", std::string(R"({"command":"path","points":)") + points + "}"));
  };
  EXPECT_EQ(send_path("[[10,10],[40,10]]"), 200);
  EXPECT_EQ(send_path("[[10,10],[10,90]]"), 422) << "20 deg";
  EXPECT_EQ(send_path("[[10,10],[500,10]]"), 422) << "outside";
  EXPECT_EQ(server.taken().size(), 1U);
  const json check = json_of(post(server.port(), "/api/check", R"({"points":[[10,10],[10,90]]})"));
  EXPECT_EQ(check["passable"], false);
  EXPECT_NEAR(check["max_slope_deg"], 20.05, 0.1);
}

// 500 points may zigzag over the whole map.
TEST(Page, TooLongPathsAreRefusedBeforeTheyAreSampled) {
  TestServer server([](PageConfig& config, PageContext&) { config.path.max_length_m = 100.0; });
  const std::string points = R"("points":[[10,10],[90,10],[10,11]])";
  const std::string check = post(server.port(), "/api/check", "{" + points + "}");
  EXPECT_EQ(status_of(check), 422);
  EXPECT_EQ(json_of(check)["reason"], "the path is 160 m long; the limit is 100 m");
  EXPECT_EQ(status_of(post(server.port(), "/api/command", R"({"command":"path",)" + points + "}")), 422);
  EXPECT_EQ(status_of(post(server.port(), "/api/check", R"({"points":[[10,10],[90,10]]})")), 200);
}

TEST(Page, WithoutAMapNoPathIsTaken) {
  TestServer server([](PageConfig&, PageContext& context) { context.run_dir = ""; });
  EXPECT_EQ(status_of(post(server.port(), "/api/command", R"({"command":"path","points":[[1,1],[2,2]]})")), 422);
  EXPECT_TRUE(json_of(get(server.port(), "/api/setup"))["map"].is_null());
  EXPECT_TRUE(server.taken().empty());
}

TEST(Page, ServicesAreKilledOnlyWhereInjectionIsAllowed) {
  const std::string kill = R"({"command":"kill","service":"stereo"})";
  {
    TestServer server;
    EXPECT_EQ(status_of(post(server.port(), "/api/command", kill)), 403);
    EXPECT_TRUE(server.injected().empty());
  }
  TestServer server([](PageConfig&, PageContext& context) { context.allow_injection = true; });
  EXPECT_EQ(status_of(post(server.port(), "/api/command", kill)), 200);
  EXPECT_EQ(status_of(post(server.port(), "/api/command", R"({"command":"hang","service":"localization"})")), 200);
  EXPECT_EQ(status_of(post(server.port(), "/api/command", R"({"command":"kill","service":"init"})")), 422);
  EXPECT_EQ(server.injected(), (std::vector<std::string>{"kill stereo", "hang localization"}));
  EXPECT_TRUE(server.taken().empty()) << "nothing of it goes over the bus";
}

TEST(Page, ViewsAreStreamedToAsManyAsMayCome) {
  TestServer server;
  std::vector<int> open(5);
  for (int i = 0; i < 4; ++i) {
    const std::string got = open_stream(server.port(), "", open[static_cast<size_t>(i)]);
    EXPECT_NE(got.find("text/event-stream"), std::string::npos);
    EXPECT_NE(got.find("event: view\ndata: {"), std::string::npos);
  }
  EXPECT_EQ(status_of(open_stream(server.port(), "", open[4])), 503);
  for (const int fd : open) close(fd);
}

TEST(Page, WithATokenNothingIsShownWithoutIt) {
  const std::string token = "0123456789abcdef";
  TestServer server([&](PageConfig& config, PageContext&) { config.guard.token = token; });
  EXPECT_EQ(status_of(get(server.port(), "/")), 401);
  EXPECT_EQ(status_of(get(server.port(), "/api/stream")), 401);
  EXPECT_EQ(status_of(post(server.port(), "/api/command", R"({"command":"go"})")), 401);
  EXPECT_EQ(status_of(get(server.port(), "/?token=wrong")), 401);
  const std::string welcome = get(server.port(), "/?token=" + token);
  EXPECT_EQ(status_of(welcome), 303);
  EXPECT_NE(welcome.find("rover_token=" + token + "; HttpOnly; SameSite=Strict"), std::string::npos);
  const std::string with_cookie =
      "GET / HTTP/1.1\r\nConnection: close\r\nHost: rover:1\r\nCookie: rover_token=" + token + "\r\n\r\n";
  EXPECT_EQ(status_of(talk(server.port(), with_cookie)), 200);
  EXPECT_TRUE(server.taken().empty());
}

// Neither a body nor the rest of one is waited for.
TEST(Page, TheTokenIsJudgedBeforeTheBodyIsRead) {
  TestServer server([](PageConfig& config, PageContext&) {
    config.guard.token = "0123456789abcdef";
    config.limits.request_time = std::chrono::minutes(10);
  });
  const std::string post = "POST /api/command HTTP/1.1\r\nHost: rover:1\r\n";
  const std::string answer = talk(server.port(), post + "Content-Length: 60000\r\n\r\n");
  EXPECT_EQ(status_of(answer), 401);
  EXPECT_EQ(status_of(talk(server.port(), post + "Transfer-Encoding: chunked\r\n\r\n1000\r\n")), 401);
  wild_row("The page's server", "a body without the token", "401", body_of(answer));
}

TEST(Page, APortThatIsTakenIsTriedAgainAndSharedWithNobody) {
  TestServer first;
  SharedState shared;
  PageConfig config;
  config.guard.port = first.port();
  PageContext context;
  lcm::LCM bus("memq://");
  context.setup = json::object();
  PageServer second(config, context, shared, bus);
  second.start();
  for (int i = 0; i < 5000 && shared.page_is_served; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(shared.page_is_served);
  EXPECT_FALSE(second.serving());
  EXPECT_EQ(json_of(get(first.port(), "/api/setup"))["run"], "test");
}

}  // namespace
}  // namespace rover::mission::test
