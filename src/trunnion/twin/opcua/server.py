"""The OPC UA server of a twin: its address space, its security, and its start and end."""

import logging
import secrets
import socket
from pathlib import Path
from typing import Any, Final

from asyncua import Server, ua
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.server.internal_server import InternalServer
from asyncua.server.internal_session import InternalSession

from trunnion.records import dataclass
from trunnion.twin.opcua.certificates import server_certificate
from trunnion.twin.opcua.cnc import build_cnc
from trunnion.twin.opcua.events import Events
from trunnion.twin.opcua.history import TwinHistory
from trunnion.twin.opcua.machine_tool import build_machine_tool
from trunnion.twin.opcua.motion import build_motion
from trunnion.twin.opcua.operating import OVERRIDE, Operated, TwinAttributes, TwinRules, build_operating
from trunnion.twin.opcua.publisher import Publisher
from trunnion.twin.opcua.sinumerik import VARIABLES, build_sinumerik
from trunnion.twin.opcua.space import VERSION, Space
from trunnion.twin.opcua.subscriptions import TwinSubscriptions
from trunnion.twin.opcua.transport import TwinBinaryServer
from trunnion.twin.opcua.users import Role, Users
from trunnion.twin.opcua.views import TwinViews
from trunnion.twin.snapshots import TwinProgram

#: Bounds of what clients can have open: connections, seconds until one has a session, requests that wait in one.
_MOST_CONNECTIONS: Final = 100
_SECONDS_TO_SESSION: Final = 10.0
_MOST_REQUESTS: Final = 100
_MOST_SUBSCRIPTIONS: Final = 200
_MOST_UNACKNOWLEDGED: Final = 50

_SECURED: Final = [
    ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt,
    ua.SecurityPolicyType.Aes128Sha256RsaOaep_SignAndEncrypt,
    ua.SecurityPolicyType.Aes256Sha256RsaPss_SignAndEncrypt,
]

# The library says what it has to say by statuses and errors; nothing goes to stderr where no log is set up.
logging.getLogger("asyncua").addHandler(logging.NullHandler())


@dataclass(frozen=True, slots=True)
class Security:
    """Who may use a twin that other computers can reach: users with passwords, on channels that are encrypted.

    folder   where the certificate of the server is kept
    """

    users: Users
    folder: Path


#: Who a session is of before it is activated.
_NOBODY: Final = User(role=UserRole.Anonymous)


class _UserManager:
    """Who a client is: anybody on this computer, a user with a password from elsewhere."""

    def __init__(self, users: Users | None) -> None:
        self._users = users

    def get_user(
        self, iserver: Any, username: str | None = None, password: str | None = None, certificate: Any = None
    ) -> User | None:
        """Return the user, whose role is Anonymous if he only looks; None: nobody who may."""
        if self._users is None:
            return User(UserRole.User)
        role = self._users.role_of(username, password) if username and password else None
        if role is None:
            return None
        return User(UserRole.User if role is Role.OPERATOR else UserRole.Anonymous, username)


class _InternalServer(InternalServer):
    """The services of the server, with what clients could do to each other taken away."""

    def __init__(self, users: Users | None) -> None:
        super().__init__(user_manager=_UserManager(users))
        self.max_connections = _MOST_CONNECTIONS
        self.max_pending_activation_seconds = _SECONDS_TO_SESSION
        self.max_pending_messages_per_connection = _MOST_REQUESTS
        self.max_subscriptions = _MOST_SUBSCRIPTIONS
        self.max_unacked_messages_per_subscription = _MOST_UNACKNOWLEDGED
        self.allow_remote_admin = False
        self.subscriptions = TwinSubscriptions(self.aspace, self)
        self.subscription_service = self.isession.subscription_service = self.subscriptions
        self.history = TwinHistory()
        self.history_manager.set_storage(self.history)

    def create_session(self, name: str, user: User = _NOBODY, external: bool = False) -> InternalSession:
        """Make a session whose token cannot be guessed: it is all that one needs to take it over."""
        session = super().create_session(name, user, external)
        if external:
            self.unregister_external_session(session)
            session.auth_token = ua.NodeId(secrets.token_bytes(24), 0, ua.NodeIdType.ByteString)
            self.register_external_session(session)
        return session

    def register_server(self, server: Any, conf: Any = None) -> None:
        """Refuse: this is no discovery server."""
        raise ua.uaerrors.BadServiceUnsupported


class TwinServer(Server):
    """The server of a program that runs on a machine.

    program    what runs
    operated   what clients operate
    listening  the socket on which it serves; its address is part of the endpoint
    host       address by which clients name this computer
    security   None: anybody on this computer reads and operates it
    """

    def __init__(
        self, program: TwinProgram, operated: Operated, listening: socket.socket, host: str, security: Security | None
    ) -> None:
        self._internal = _InternalServer(security.users if security else None)
        super().__init__(iserver=self._internal)
        self._program, self._operated = program, operated
        self._listening, self._host, self._security = listening, host, security
        shown = f"[{host}]" if ":" in host else host
        self.address = f"opc.tcp://{shown}:{listening.getsockname()[1]}/trunnion"
        self.fingerprint = ""
        self.space = Space(self)
        self.events = Events(self.space)

    @property
    def subscriptions(self) -> TwinSubscriptions:
        """What clients have subscribed to."""
        return self._internal.subscriptions

    async def prepare(self, speed: float | None) -> Publisher:
        """Build the address space; returns what publishes its values."""
        await self.init()
        self.set_endpoint(self.address)
        self.set_server_name("Trunnion twin")
        self.application_type = ua.ApplicationType.Server
        self.product_uri, self.manufacturer_name = "urn:trunnion", "Trunnion"
        application = f"urn:{socket.gethostname()}:trunnion:twin"
        await self.set_application_uri(application)
        status = await self.get_node(ua.NodeId(ua.ObjectIds.Server_ServerStatus)).read_value()
        built = status.BuildInfo.BuildDate
        await self.set_build_info(self.product_uri, self.manufacturer_name, self.name, VERSION, "", built)
        await self._secure(application)
        space, program = self.space, self._program
        await space.load([VARIABLES])
        await build_cnc(space, program)
        await build_machine_tool(space, program)
        await build_sinumerik(space, program)
        await build_operating(space, self._operated, speed, program.timed.duration)
        await build_motion(space, program)
        await self.events.prepare()
        attributes = TwinAttributes(self.iserver.aspace, space.id_of(OVERRIDE), self._operated)
        self.iserver.attribute_service = attributes
        self.iserver.view_service = TwinViews(self.iserver.aspace)
        return Publisher(space, self._internal.history)

    async def _secure(self, application: str) -> None:
        if self._security is None:
            self.set_security_policy([ua.SecurityPolicyType.NoSecurity], TwinRules())
            self.set_identity_tokens([ua.AnonymousIdentityToken])
            return
        made = server_certificate(self._security.folder, application, self._host)
        self.fingerprint = made.fingerprint
        await self.load_certificate(made.certificate)
        await self.load_private_key(made.key)
        self.set_security_policy(_SECURED, TwinRules())
        self.set_identity_tokens([ua.UserNameIdentityToken])

    async def start(self) -> None:
        """Serve."""
        await self._setup_server_nodes()
        await self.iserver.start()
        self.bserver = TwinBinaryServer(self.iserver, self._listening, secured=self._security is not None)
        self.bserver.set_policies(self._policies)
        await self.bserver.start()

    async def stop(self) -> None:
        """End all connections and subscriptions."""
        await self.subscriptions.delete_subscriptions(list(self.subscriptions.subscriptions))
        await super().stop()
