#pragma once

namespace lacuna {

/// Exit codes of `lacuna`, printed by --help.
enum ExitCode : int {
  exit_done = 0,
  exit_error = 1,    ///< something else went wrong
  exit_bad_job = 2,  ///< the job file or the command line
  exit_asset = 3,    ///< a scene, texture, reference or environment
  exit_memory = 71,  ///< out of memory; with more, the same command goes on
  /// Stopped with a checkpoint, or the disk is full; the same command goes on.
  exit_interrupted = 75
};

}  // namespace lacuna
