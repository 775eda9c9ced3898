#pragma once

#include "telltale/service/storage/schema.hpp"

namespace telltale {

/// Each published model, each vehicle's last diagnosis, and those before it.
const Schema& ModelsSchema();

/// The windows of the fleet in chunks.
const Schema& WindowsSchema();

/// The requests that wait for their answers.
const Schema& RequestsSchema();

/// The boats that have announced themselves: VehicleStore.
const Schema& VehiclesSchema();

/// The latest term of a daemon that stands in for another: TermStore.
const Schema& TermsSchema();

/// Which daemon serves which part of the fleet: SliceLeases.
const Schema& SlicesSchema();

/// The heavy jobs that wait for a worker, and the workers: OfferedJobs, TakenJobs.
const Schema& JobsSchema();

}  // namespace telltale
