// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors
#pragma once

namespace thermopower::gap::engine {

/// What is said where nothing above the noise is left.
inline constexpr const char* wholly_explained =
    "the named cause brings held-out data near the noise, and nothing else does";

/// The same where several explanations do.
inline constexpr const char* several_explain = "several explanations bring held-out data near the noise";

/// The same where the printed table shows a signal above the noise.
inline constexpr const char* several_leave_a_rest =
    "several explanations bring held-out data nearer to the noise, none of them all the way, and what remains does not "
    "tell which";

/// What is said where several explanations take a proven part away and leave a rest.
inline constexpr const char* several_take_a_part =
    "several explanations take a proven part of the gap away, and what remains of it does not tell which";

/// What is said where constants alone do not bring the data to the noise, and no effect does better.
inline constexpr const char* constants_leave_a_rest =
    "there is a gap; other constants take the most of it away, and no effect of the catalogue explains what they "
    "leave above the noise";

/// What is said where the parts of the data disagree about a cause that leaves most of the gap.
inline constexpr const char* stands_in_for_another =
    "there is a gap, and the cause that lowers it most leaves most of it and is of another size in each part of the data: "
    "it stands in for one that the catalogue lacks";

/// What is said where the data tell no parameter of a cause.
inline constexpr const char* may_be_of_any_size =
    "there is a gap, and of the cause that lowers it most the data tell nothing: each of its parameters may be anything in its "
    "range";

/// What is said where a cause that leaves a rest takes a constant along that nothing else asks to move.
inline constexpr const char* bends_a_constant =
    "there is a gap, and the cause that lowers it most leaves a rest and needs a constant further off than a constant can be "
    "that other constants alone do not show: together they stand in for a cause that the catalogue lacks";

/// What is said where the place of a cause, or the place that was at fault, is still to blame with the cause in the model.
inline constexpr const char* does_not_mend_its_place =
    "there is a gap, and the cause that lowers it most leaves a good part of it and its place at fault: it stands in for one "
    "that the catalogue lacks";

/// What is said where a cause leaves a rest and acts in no place that the rows blame.
inline constexpr const char* acts_where_nothing_is_wrong =
    "there is a gap, and the cause that lowers it most leaves a rest and acts in no place that the measured rows find at "
    "fault: it stands in for one that the catalogue lacks";

/// What is said where the fault began in the middle of runs and a cause leaves a rest.
inline constexpr const char* was_not_there_before =
    "there is a gap that began in the middle of runs and would have shown before; the cause that lowers it most leaves a rest, "
    "and would have been there all along: it stands in for one that the catalogue lacks";

/// What is said of causes that are large and of opposite sign.
inline constexpr const char* cancel_each_other =
    "there is a gap, and the causes that lower it most leave a rest and nearly cancel each other, each of them larger than "
    "what is seen: their difference stands in for a cause that the catalogue lacks";

/// What is said where the printed table does not prove that the causes take a part away.
inline constexpr const char* nothing_is_proven =
    "there is a gap, and what lowers it most takes no part of it away that all held-out rows prove, beyond what other "
    "constants do";

/// What is said where nothing that a cause follows orders what is missing.
inline constexpr const char* follows_nothing_recorded =
    "there is a gap that follows nothing that a cause follows but has a course of its own, in time or over the angle; what "
    "lowers it most follows that course only in part";

/// What is said beside a rest.
inline constexpr const char* partly_explained =
    "the named cause takes a proven part of the held-out gap away, and the rest stays above the noise";

/// What is said where the simulation as configured is near the noise, and no cause proves to bring it nearer.
inline constexpr const char* is_as_near =
    "the simulation is as near the noise as an explanation would have to bring it, and no cause makes that better on all "
    "held-out rows";

/// What is said where constants bring it there, and a cause takes little of what they leave.
inline constexpr const char* constants_come_as_near =
    "with its constants within what is known of them the simulation is as near the noise as an explanation would have to "
    "bring it, and no cause takes more than a little of the rest";

}  // namespace thermopower::gap::engine
