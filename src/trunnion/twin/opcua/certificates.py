"""Certificates of a twin's server, and of the client that records: made on first use, kept in the user's folder."""

import hashlib
import ipaddress
import os
import socket
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Final

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass

_DAYS: Final = 3650


@dataclass(frozen=True, slots=True)
class ServerCertificate:
    """Files of a certificate (DER) and its key (PEM), and the fingerprint that a client shows."""

    certificate: Path
    key: Path
    fingerprint: str


def server_certificate(folder: Path, application: str, host: str) -> ServerCertificate:
    """Return the certificate of a folder; it is made if there is none, or none for this host and application, or it is

    over.

    folder       where it is kept; it is made if need be
    application  URI of the server, which is part of it
    host         address on which the server listens

    Raises ``InputError`` if the folder cannot be written.
    """
    name = "".join(c if c.isalnum() else "-" for c in host)
    certificate, key = folder / f"server-{name}.der", folder / f"server-{name}.key.pem"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not (key.is_file() and _is_good(certificate, application)):
            _make(certificate, key, application, host)
        data = certificate.read_bytes()
    except OSError as error:
        raise InputError(
            Problem(str(folder), 0, Wording("TWN140", "certificate_server_cannot", strerror=error.strerror))
        ) from None
    return ServerCertificate(certificate, key, hashlib.sha1(data, usedforsecurity=False).hexdigest().upper())


@dataclass(frozen=True, slots=True)
class ClientCertificate:
    """Files of a client's certificate (DER) and its key (PEM), and the URI by which the client names itself."""

    certificate: Path
    key: Path
    application: str


def client_certificate(folder: Path) -> ClientCertificate:
    """Return the certificate of a client that connects to machines; it is made if need be.

    Raises
    ------
    InputError
        If the folder cannot be written.
    """
    application = f"urn:{socket.gethostname()}:trunnion:client"
    certificate, key = folder / "client.der", folder / "client.key.pem"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not (key.is_file() and _is_good(certificate, application)):
            _make(certificate, key, application, socket.gethostname())
    except OSError as error:
        raise InputError(
            Problem(str(folder), 0, Wording("TWN140", "certificate_client_cannot", strerror=error.strerror))
        ) from None
    return ClientCertificate(certificate, key, application)


def _is_good(path: Path, application: str) -> bool:
    try:
        found = x509.load_der_x509_certificate(path.read_bytes())
        names = found.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except (OSError, ValueError, x509.ExtensionNotFound):
        return False
    is_ours = application in names.get_values_for_type(x509.UniformResourceIdentifier)
    return is_ours and found.not_valid_after_utc > datetime.now(UTC) + timedelta(days=1)


def _make(certificate: Path, key: Path, application: str, host: str) -> None:
    private = rsa.generate_private_key(public_exponent=65537, key_size=2048)
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "Trunnion")])
    now = datetime.now(UTC)
    identifier = x509.SubjectKeyIdentifier.from_public_key(private.public_key())
    names: list[x509.GeneralName] = [x509.UniformResourceIdentifier(application), x509.DNSName(socket.gethostname())]
    try:
        names.append(x509.IPAddress(ipaddress.ip_address(host)))
    except ValueError:
        names.append(x509.DNSName(host))
    usage = x509.KeyUsage(
        digital_signature=True, content_commitment=True, key_encipherment=True, data_encipherment=True,
        key_agreement=False, key_cert_sign=True, crl_sign=False, encipher_only=False, decipher_only=False,
    )  # fmt: skip
    made = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(private.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))
        .not_valid_after(now + timedelta(days=_DAYS))
        .add_extension(x509.SubjectAlternativeName(names), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(usage, critical=True)
        .add_extension(
            x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]), critical=False
        )
        .add_extension(identifier, critical=False)
        .add_extension(x509.AuthorityKeyIdentifier.from_issuer_subject_key_identifier(identifier), critical=False)
        .sign(private, hashes.SHA256())
    )
    pem = private.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    key.unlink(missing_ok=True)
    # Only this user reads the key, from the first byte on.
    with os.fdopen(os.open(key, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as sink:
        sink.write(pem)
    certificate.write_bytes(made.public_bytes(serialization.Encoding.DER))
