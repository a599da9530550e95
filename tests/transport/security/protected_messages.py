"""Messages that DDS Security protects (OMG DDS Security 1.1, 9.5): reads them, and signs others with the same keys."""

import ctypes
import struct

HEADER, CRYPTO, TAG = 20, 20, 16
RECEIVER_TAG = 4 + TAG
PREFIX, POSTFIX, MESSAGE_PREFIX, MESSAGE_POSTFIX = 0x31, 0x32, 0x33, 0x34
IV, IV_SUFFIX = 12, 8


class Submessage:
    def __init__(self, datagram, at):
        self.kind, self.flags = datagram[at], datagram[at + 1]
        self.order = "<" if self.flags & 1 else ">"
        length = struct.unpack_from(self.order + "H", datagram, at + 2)[0]
        self.end = at + 4 + length if length or self.kind in (1, 9) else len(datagram)
        self.whole = bytes(datagram[at:self.end])


def submessages(datagram, at=HEADER):
    while at + 4 <= len(datagram):
        each = Submessage(datagram, at)
        yield at, each
        at = each.end


def submessage(kind, body, flags=1):
    return struct.pack("<BBH", kind, flags, len(body)) + body


class Crypto:
    """AES-256 in Galois counter mode, over text that is signed and not encrypted."""

    _library = ctypes.CDLL("libcrypto.so.3")
    for _name in ("EVP_CIPHER_CTX_new", "EVP_aes_256_gcm"):
        getattr(_library, _name).restype = ctypes.c_void_p

    @classmethod
    def tag(cls, key, iv, text):
        library, size, tag = cls._library, ctypes.c_int(), ctypes.create_string_buffer(TAG)
        context = ctypes.c_void_p(library.EVP_CIPHER_CTX_new())
        get_tag = 0x10
        done = (library.EVP_EncryptInit_ex(context, ctypes.c_void_p(library.EVP_aes_256_gcm()), None, key, iv) == 1
                and library.EVP_EncryptUpdate(context, None, ctypes.byref(size), text, len(text)) == 1
                and library.EVP_EncryptFinal_ex(context, tag, ctypes.byref(size)) == 1
                and library.EVP_CIPHER_CTX_ctrl(context, get_tag, TAG, tag) == 1)
        library.EVP_CIPHER_CTX_free(context)
        assert done
        return tag.raw


class Protection:
    """What stands around protected content: a prefix, and a postfix with one tag for all and one for each receiver."""

    def __init__(self, prefix, content, postfix, keys):
        """`keys`: session keys, of which some may fit."""
        self._prefix = prefix
        self._head = postfix[:4]
        iv, tag = prefix[-IV:], postfix[4:4 + TAG]
        tags = postfix[4 + TAG + 4:]
        self._key = next((key for key in keys if Crypto.tag(key, iv, content) == tag), None)
        # (number of the key, key) of the receivers whose key is among these.
        self._receivers = []
        for at in range(0, len(tags) if self._key else 0, RECEIVER_TAG):
            found = [key for key in keys if Crypto.tag(key, iv, tag) == tags[at + 4:at + RECEIVER_TAG]]
            self._receivers += [(tags[at:at + 4], key) for key in found[:1]]

    def is_known(self):
        return self._key is not None

    def receivers(self):
        return len(self._receivers)

    def around(self, content, count, tags=None):
        """Protects other content. `count`: makes the initialization vector. `tags`: (number of the key, tag) for each receiver;
        None: the right ones."""
        prefix = self._prefix[:-IV_SUFFIX] + struct.pack(">II", 0xffff0000, count)
        iv = prefix[-IV:]
        tag = Crypto.tag(self._key, iv, content)
        if tags is None:
            tags = [(number, Crypto.tag(key, iv, tag)) for number, key in self._receivers]
        body = tag + struct.pack(">I", len(tags)) + b"".join(number + each for number, each in tags)
        order = "<" if self._head[1] & 1 else ">"
        return prefix + content + self._head[:2] + struct.pack(order + "H", len(body)) + body


class Signer:
    """Signs messages as the participant that has sent `datagram`, with some of its keys."""

    def __init__(self, datagram, keys):
        self.prefix = bytes(datagram[8:HEADER])
        self._header = bytes(datagram[:HEADER])
        self._count = 0
        begin, end = HEADER + 4 + CRYPTO, [at for at, _ in submessages(datagram)][-1]
        self._protection = Protection(bytes(datagram[HEADER:begin]), bytes(datagram[begin:end]), bytes(datagram[end:]), keys)

    def is_known(self):
        return self._protection.is_known()

    def receivers(self):
        return self._protection.receivers()

    def message(self, content, tags=None):
        self._count += 1
        return self._header + self._protection.around(content, self._count, tags)
