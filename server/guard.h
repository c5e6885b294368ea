#pragma once

#include "server/message.h"

namespace lacuna {

/// Refuses (HttpError 403) what a page of another site could make a browser send: a Host that is no
/// name of this machine (DNS rebinding), and an unsafe method from another Origin.
void check_sender(const Request& request);

}  // namespace lacuna
