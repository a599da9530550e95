#pragma once

#include <string>
#include <string_view>

#include "keys/OpenSsl.h"

namespace Rabit::Keys
{

// Signs a text as DDS requires: S/MIME, with the text in the clear.
std::string SignDocument(std::string_view text, X509 &authority, EVP_PKEY &key);

// Returns the text of a document that this authority has signed; the authority's dates are not checked.
// Throws KeysError, which names `file`.
std::string VerifiedDocument(std::string_view document, const X509 &authority, const std::string &file);

}  // namespace Rabit::Keys
