"""The server of the page, for this machine only and for no files but those of the page."""

import sys
import threading
import traceback
from collections import OrderedDict
from collections.abc import Callable, Mapping
from functools import partial
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from typing import Any, Final
from urllib.parse import parse_qsl, urlsplit

from rockframe import plot
from rockframe.errors import PLEASE_REPORT, ComponentError, RockframeError, collected_warnings
from rockframe.reports.page import BANNERS
from rockframe.results.outcome import verdict_of
from rockframe.serve import page
from rockframe.serve.controls import (
    FREE_VIBRATION,
    NamedRecord,
    TrialScene,
    motion_choices,
    read_choice,
)
from rockframe.serve.page import TrialOutcome

LOOPBACK: Final = "127.0.0.1"
_PLAYER_TITLE: Final = "Animation of the run"
_CACHE_SIZE: Final = 16
"""Number of outcomes kept, so that the player of a run is available when its frame loads."""
_MAX_FIELDS: Final = 50
_TIMEOUT: Final = 30.0
"""Time after which a silent client is disconnected [s]."""
_HTML: Final = "text/html; charset=utf-8"
_PLAIN: Final = "text/plain; charset=utf-8"
_FILES: Final = {page.STYLE: "text/css", page.SCRIPT: "text/javascript"}
_POLICY: Final = (
    "default-src 'none'; style-src 'self'; script-src 'self'; connect-src 'self'; "
    "frame-src 'self'; img-src data:; form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
_PLAYER_POLICY: Final = (
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "frame-ancestors 'self'"
)


class Server(ThreadingHTTPServer):
    """A server of the page at a port of this machine, or at any free one for port 0."""

    daemon_threads = True
    allow_reuse_address = sys.platform != "win32"

    def __init__(self, port: int = 0, record: NamedRecord | None = None) -> None:
        try:
            super().__init__((LOOPBACK, port), _RequestHandler)
        except (OSError, OverflowError) as problem:
            msg = (
                f"serve: port {port} cannot be opened ({problem}); expected a free one from 1024 "
                "to 65535, or 0 for any"
            )
            raise ComponentError(msg) from problem
        self.record = record
        self.hosts = {f"{name}:{self.server_port}" for name in (LOOPBACK, "localhost")}
        self._lock = threading.Lock()  # one run at a time, and one user of matplotlib
        self._outcomes = OrderedDict[str, TrialOutcome]()

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{LOOPBACK}:{self.server_port}/"

    def outcome(self, choice: TrialScene) -> TrialOutcome:
        """Simulate a choice, or give its outcome if it is kept."""
        toml = choice.toml(self.record)
        with self._lock:
            if toml not in self._outcomes:
                self._outcomes[toml] = self._simulate(choice, toml)
                if len(self._outcomes) > _CACHE_SIZE:
                    self._outcomes.popitem(last=False)
            self._outcomes.move_to_end(toml)
            return self._outcomes[toml]

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Report no client that is gone: a browser leaves what a newer request replaces."""
        if not isinstance(sys.exception(), ConnectionError):
            super().handle_error(request, client_address)

    def _simulate(self, choice: TrialScene, toml: str) -> TrialOutcome:
        with collected_warnings() as warned:
            motion = choice.ground_motion(self.record)
            run = choice.system().simulate(motion, free_vibration=FREE_VIBRATION)
            player = plot.player(run, title=_PLAYER_TITLE).to_html()
        title, kind = BANNERS[verdict_of(run)]
        return TrialOutcome(title, str(run.attrs["verdict"]), kind, tuple(warned), toml, player)


class _RequestHandler(BaseHTTPRequestHandler):
    server: Server  # pyright: ignore[reportIncompatibleVariableOverride]
    server_version = "rockframe"
    sys_version = ""
    timeout = _TIMEOUT  # pyright: ignore[reportAssignmentType]

    def do_GET(self) -> None:
        """Answer a request."""
        if not self._is_same_origin():
            words = "This page answers to its own address on this machine only.\n"
            self._send(HTTPStatus.FORBIDDEN, _PLAIN, words)
            return
        try:
            target = urlsplit(self.path)
        except ValueError as problem:
            words = f"This is no address of a page: {problem}\n"
            self._send(HTTPStatus.BAD_REQUEST, _PLAIN, words)
            return
        if target.path in _FILES:
            file = resources.files("rockframe.serve") / target.path.removeprefix("/")
            text = file.read_text(encoding="utf-8")
            self._send(HTTPStatus.OK, f"{_FILES[target.path]}; charset=utf-8", text)
            return
        answers: dict[str, Callable[[Mapping[str, str]], None]] = {
            "/": self._send_page, "/outcome": partial(self._send_page, whole=False),
            "/player": self._send_player, "/scene.toml": self._send_scene,
        }  # fmt: skip
        if target.path not in answers:
            words = f"There is no such page; the page is at {self.server.address}\n"
            self._send(HTTPStatus.NOT_FOUND, _PLAIN, words)
            return
        try:
            query = dict(parse_qsl(target.query, max_num_fields=_MAX_FIELDS,
                                   keep_blank_values=True))  # fmt: skip
        except ValueError:
            self._send(HTTPStatus.BAD_REQUEST, _HTML, page.faults_html(["too many values"]))
            return
        answers[target.path](query)

    def _is_same_origin(self) -> bool:
        """Whether a request is from the page itself, not from another page in the browser."""
        hosts = self.server.hosts
        origin = self.headers.get("Origin")
        return (
            self.headers.get("Host", "") in hosts
            and (origin is None or origin in {f"http://{host}" for host in hosts})
            and self.headers.get("Sec-Fetch-Site") not in ("cross-site", "same-site")
        )

    def _evaluate(
        self, query: Mapping[str, str]
    ) -> tuple[TrialScene, TrialOutcome | None, list[str]]:
        choice, faults = read_choice(query, self.server.record)
        if faults:
            return choice, None, faults
        try:
            return choice, self.server.outcome(choice), []
        except RockframeError as problem:
            return choice, None, [str(problem)]
        except Exception:  # the page remains, whatever fails in a run
            traceback.print_exc()
            return choice, None, [f"The run failed: {PLEASE_REPORT}."]

    def _send_page(self, query: Mapping[str, str], *, whole: bool = True) -> None:
        """Send the page, or only its part with the outcome."""
        choice, outcome, faults = self._evaluate(query)
        part = page.faults_html(faults) if outcome is None else page.outcome_html(outcome, query)
        if whole:
            part = page.trial_page(choice, motion_choices(self.server.record), part)
        self._send(HTTPStatus.OK, _HTML, part)

    def _send_player(self, query: Mapping[str, str]) -> None:
        _, outcome, faults = self._evaluate(query)
        if outcome is None:
            self._send(HTTPStatus.BAD_REQUEST, _HTML, page.faults_html(faults))
        else:
            self._send(HTTPStatus.OK, _HTML, outcome.player, _PLAYER_POLICY)

    def _send_scene(self, query: Mapping[str, str]) -> None:
        choice, faults = read_choice(query, self.server.record)
        if faults:
            self._send(HTTPStatus.BAD_REQUEST, _PLAIN, "\n".join(faults) + "\n")
        else:
            self._send(HTTPStatus.OK, _PLAIN, choice.toml(self.server.record))

    def _send(self, status: HTTPStatus, kind: str, text: str, policy: str = _POLICY) -> None:
        data = text.encode()
        self.send_response(status)
        for name, value in {
            "Content-Type": kind,
            "Content-Length": str(len(data)),
            "Content-Security-Policy": policy,
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Cache-Control": "no-store",
        }.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(data)

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002
        """Log no requests."""
