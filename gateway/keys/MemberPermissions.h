#pragma once

#include <string>
#include <vector>

#include "envelope/Permissions.h"
#include "keys/Access.h"

namespace Rabit::Keys
{

// Returns the list that allows exactly these topics. Partitions are not part of a list: names are bound to
// certificates. Throws KeysError if there are too many topics.
Envelope::Permissions PermissionsFor(const Access &access);

// Returns the topics of `access` that the list does not allow, each as `write Pose` or `read Pose`.
std::vector<std::string> Lacks(const Envelope::Permissions &list, Envelope::CertificateRole role,
                               const Access &access);

}  // namespace Rabit::Keys
