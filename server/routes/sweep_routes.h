#pragma once

#include <cstdint>
#include <list>
#include <mutex>
#include <string>

#include "server/http/router.h"
#include "server/keeper/sweep_keeper.h"
#include "server/routes/sweep_posting.h"

namespace lacuna {

/// The routes below /api/sweeps, and /api/schema/sweep. All references must outlive it.
class SweepRoutes {
 public:
  SweepRoutes(const ScenesRoots& scenes, Store& store, SweepFolders& folders, SweepKeeper& keeper);
  void add_to(Router& router);

 private:
  void add_collection(Router& router);
  void add_one(Router& router);
  void add_results(Router& router);

  Response list(const Request& request) const;
  Response detail(const Request& request, const std::string& id);
  Response cancel(const Request& request, const std::string& id);
  Response remove(const Request& request, const std::string& id);
  Response answers(const Request& request, const std::string& id);
  Response table(const Request& request, const std::string& id);

  SweepFolders::FolderPtr open(const SweepEntry& sweep);
  std::string answers_of(const SweepEntry& sweep);

  Store& store_;
  SweepFolders& folders_;
  SweepKeeper& keeper_;
  SweepPosting posting_;

  /// Cached answers of a sweep that is over, which require reading all its curves.
  struct KnownAnswers {
    std::string sweep;
    std::int64_t change;  // latest of its runs
    std::size_t runs;     // existing ones
    std::string text;
  };
  std::mutex mutex_;  // guards the next
  std::list<KnownAnswers> known_;
};

}  // namespace lacuna
