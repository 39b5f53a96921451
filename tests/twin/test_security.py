"""A twin that other computers reach: encrypted channels, users with passwords, and nothing without them."""

import asyncio
from pathlib import Path

import pytest
from asyncua import Client, ua
from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256

from tests.support.twins import HUB_ROUGH, ServedTwin, served
from trunnion.jobs.twin.serving import add_twin_user
from trunnion.twin.opcua.certificates import server_certificate

PASSWORD = "correct horse"


def test_other_computers_need_a_user_and_an_encrypted_channel(tmp_path: Path) -> None:
    users = tmp_path / "users"
    add_twin_user("ada", PASSWORD, users=users)
    add_twin_user("eve", PASSWORD, operator=False, users=users)
    options = ("--host", "0.0.0.0", "--users", str(users), "--hold", "--no-mtconnect")
    with served(HUB_ROUGH, *options, home=tmp_path) as twin:
        an_operator_operates_and_a_viewer_looks(twin, tmp_path)
        nobody_else_comes_in(twin, tmp_path)
        a_channel_without_security_tells_the_endpoints_and_nothing_else(twin)


async def connected(twin: ServedTwin, home: Path, user: str, password: str) -> Client:
    """A client with a certificate of its own, as a user."""
    address = twin.opcua.replace("0.0.0.0", "127.0.0.1")
    client = Client(address, timeout=120, watchdog_intervall=600)
    client.application_uri = "urn:test:client"
    made = server_certificate(home / "client", client.application_uri, "client")
    client.set_user(user)
    client.set_password(password)
    await client.set_security(SecurityPolicyBasic256Sha256, made.certificate, made.key)
    await client.connect()
    return client


def an_operator_operates_and_a_viewer_looks(twin: ServedTwin, home: Path) -> None:
    async def use(user: str) -> tuple[str, bool]:
        client = await connected(twin, home, user, PASSWORD)
        try:
            space = await client.get_namespace_index("urn:trunnion:twin")
            state = await client.get_node(ua.NodeId("Twin.State", space)).read_value()
            try:
                await client.get_node(ua.NodeId("Twin", space)).call_method(ua.NodeId("Twin.Reset", space))
            except ua.UaStatusCodeError:
                return state, False
            return state, True
        finally:
            await client.disconnect()

    assert asyncio.run(use("ada")) == ("ready", True)
    assert asyncio.run(use("eve")) == ("ready", False)


def nobody_else_comes_in(twin: ServedTwin, home: Path) -> None:
    for user, password in (("ada", "wrong horse"), ("bob", PASSWORD), ("", "")):
        with pytest.raises(ua.UaError):
            asyncio.run(connected(twin, home, user, password))


def a_channel_without_security_tells_the_endpoints_and_nothing_else(twin: ServedTwin) -> None:
    client = Client(twin.opcua.replace("0.0.0.0", "127.0.0.1"), timeout=120)
    endpoints = asyncio.run(client.connect_and_get_server_endpoints())
    assert {each.SecurityMode for each in endpoints} == {ua.MessageSecurityMode.SignAndEncrypt}
    assert {token.TokenType for each in endpoints for token in each.UserIdentityTokens} == {ua.UserTokenType.UserName}

    async def session() -> None:
        await client.connect_socket()
        try:
            await client.send_hello()
            await client.open_secure_channel()
            await client.create_session()
        finally:
            client.disconnect_socket()

    with pytest.raises(ua.UaStatusCodeError, match=r"BadSecurityModeRejected|security mode"):
        asyncio.run(session())


def test_its_certificate_stays_until_it_is_of_another_server(tmp_path: Path) -> None:
    first = server_certificate(tmp_path, "urn:one", "10.0.0.1")
    assert server_certificate(tmp_path, "urn:one", "10.0.0.1") == first
    assert server_certificate(tmp_path, "urn:two", "10.0.0.1").fingerprint != first.fingerprint
