// One job: drives it and writes its row.
#pragma once

#include <cstdint>
#include <string>

namespace rover::campaign {

enum class Keep { kNone, kFailures, kAll };

struct WorkerArguments {
  std::string dir;   // of the campaign
  std::string work;  // of the session
  int job = 0;
  int attempt = 1;
  Keep keep = Keep::kFailures;
  std::uint64_t min_free_bytes = 0;  // with less the disk counts as full
};

// Exit status: 0 if there is a row, 1 if the drive died or the session was closed.
int do_job(const WorkerArguments& arguments);

// Free space of the folder's disk.
std::uint64_t free_bytes(const std::string& dir);

}  // namespace rover::campaign
