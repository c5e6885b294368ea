#pragma once

namespace lacuna {

/// Exit codes of `lacuna`, printed by --help.
enum ExitCode : int {
  exit_done = 0,
  exit_error = 1,    ///< any other error
  exit_bad_job = 2,  ///< invalid job file or command line
  exit_asset = 3,    ///< a scene, texture, reference or environment cannot be used
  exit_memory = 71,  ///< out of memory; with more memory, the same command continues
  /// Stopped with a checkpoint, or the disk is full, or an input cannot be read now; the same
  /// command continues.
  exit_interrupted = 75
};

}  // namespace lacuna
