#pragma once

#include <fmt/format.h>

#include <system_error>

#include "jobs/queue/queue.h"
#include "jobs/spec/problems.h"
#include "server/http/message.h"

namespace lacuna {

/// Runs a change requested by a client and converts exceptions to HTTP statuses.
template <class Change>
void apply(Change&& change) {
  try {
    change();
  } catch (const Changed& error) {
    throw HttpError(412, error.what());
  } catch (const Conflict& error) {
    throw HttpError(409, error.what());
  } catch (const BadJob& bad) {
    throw HttpError(400, "The new budget is not valid.", bad.problems());
  } catch (const std::system_error& error) {
    throw storage_error(error, "This could not be stored");
  }
}

}  // namespace lacuna
