#pragma once

#include <string>
#include <string_view>

#include "keys/OpenSsl.h"

namespace Rabit::Keys
{

// S/MIME, as DDS wants its documents: the text in the clear, and a signature.
std::string SignDocument(std::string_view text, X509 &authority, EVP_PKEY &key);

// The text of a document that this authority has signed, whatever its dates. Throws KeysError; `file` is what
// it names.
std::string VerifiedDocument(std::string_view document, const X509 &authority, const std::string &file);

}  // namespace Rabit::Keys
