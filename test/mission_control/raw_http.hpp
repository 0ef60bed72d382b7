// Requests as bytes, so that they can be wrong.
#pragma once

#include <string>

namespace rover::mission::test {

// Everything that comes back until the other side closes; empty: nothing did. Where nothing comes within
// `whole_within_ms` the other side is told that there is no more to the request. Negative: never.
std::string talk(int port, const std::string& bytes, int whole_within_ms = -1);
int connect_to(int port);
// Of an answer; 0: it is none.
int status_of(const std::string& answer);
std::string body_of(const std::string& answer);

std::string get(int port, const std::string& path);
// As the page itself sends it.
std::string post(int port, const std::string& path, const std::string& body);

int free_port();

}  // namespace rover::mission::test
