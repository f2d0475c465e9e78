// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace stillmap {

/// From now on the first SIGINT (Ctrl-C) or SIGTERM is only noted; a second one ends the program at
/// once, as it would without this call.
void note_interruption();

/// From now on a signal ends the program at once.
void note_no_interruption();

/// Whether a signal has come since note_interruption().
[[nodiscard]] bool interruption_noted();

}  // namespace stillmap
