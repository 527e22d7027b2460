"""The local page: access, reports of wrong values, and the scene file for download."""

import re
import socket
import struct
import subprocess
import threading
from http.client import HTTPConnection
from shutil import which
from time import sleep
from urllib.parse import urlencode

import numpy as np
import pytest

import rockframe as rf
from rockframe.command.files.scenes import read_scene
from rockframe.errors import ComponentError
from rockframe.serve import Server
from rockframe.serve.controls import (
    BASES,
    CONTROLS,
    PULSES,
    NamedRecord,
    motion_choices,
    read_choice,
)

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    path = tmp_path_factory.mktemp("records") / 'a "record".AT2'
    shaking = 4.0 * np.sin(np.linspace(0.0, 12.0, 200))
    rf.GroundMotion.from_arrays((shaking, "m/s^2"), "0.01 s").to_at2(path)
    return NamedRecord(rf.GroundMotion.read(path), {"file": str(path)})


@pytest.fixture(scope="module")
def server(record):
    with Server(0, record) as found:
        thread = threading.Thread(target=found.serve_forever)
        thread.start()
        yield found
        found.shutdown()
        thread.join()


@pytest.fixture
def ask(server):
    def request(path, method="GET", body=None, **headers):
        host = headers.pop("Host", f"127.0.0.1:{server.server_port}")
        connection = HTTPConnection("127.0.0.1", server.server_port, timeout=120)
        connection.putrequest(method, path, skip_host=True)
        for name, value in {"Host": host, **headers}.items():
            connection.putheader(name.replace("_", "-"), value)
        connection.endheaders(body)
        answer = connection.getresponse()
        found = answer.status, answer.read().decode(), answer.headers
        connection.close()
        return found

    return request


def test_page_shows_the_verdict_of_the_run(ask):
    status, text, headers = ask("/?motion=sine_pulse&width=0.6&height=3&amplitude=6&frequency=1")
    system = rf.System(rf.Block(width="0.6 m", height="3 m", mass="5.5 t"))
    pulse = rf.GroundMotion.sine_pulse("6 m/s^2", "1 Hz")
    assert status == 200
    verdict = system.simulate(pulse, free_vibration="5 s").attrs["verdict"]
    assert verdict.startswith("Overturned")
    assert verdict in text
    assert "script-src 'self'" in headers["Content-Security-Policy"]
    assert not re.search(r"https?://", text)  # no external resources
    player = ask("/player?motion=sine_pulse&width=0.6&height=3&amplitude=6&frequency=1")
    assert player[0] == 200
    assert '<canvas id="scene"' in player[1]
    for file in ("/page.js", "/page.css"):
        assert ask(file)[0] == 200


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("motion", ["sine_pulse", "cosine_pulse", "example", "record"])
def test_downloaded_scene_file_reproduces_the_scene(ask, record, tmp_path, base, motion):
    choices = {"base": base, "motion": motion, "scale": "1.7", "soil_damping": "0.33"}
    path = tmp_path / "scene.toml"
    path.write_text(ask(f"/scene.toml?{urlencode(choices)}")[1], encoding="utf-8")
    found = read_scene(str(path))
    choice, faults = read_choice(choices, record)
    assert faults == []
    assert found.system == choice.system()
    assert found.motion == choice.ground_motion(record)
    assert found.run == {"free_vibration": "5 s"}


def test_typed_numbers_are_used_exactly():
    choice, _ = read_choice({"width": "0.71234567"}, None)
    assert choice.system().parts.block.width.magnitude == 0.71234567


@pytest.mark.parametrize("text", ["1,000", "1,5", "1.000,5", ""])
def test_typed_numbers_with_a_comma_are_refused(text):
    choice, faults = read_choice({"mass": text}, None)
    assert faults == [f"Mass: found {text!r}; expected a number from 0.05 to 200 t"]
    assert choice.numbers["mass"] == 5.5


@pytest.mark.parametrize("headers", [
    {"Host": "evil.example"}, {"Host": "evil.example:80"}, {"Host": ""},
    {"Origin": "http://evil.example"}, {"Origin": "null"},
    {"Sec_Fetch_Site": "cross-site"}, {"Sec_Fetch_Site": "same-site"},
])  # fmt: skip
def test_foreign_hosts_and_origins_are_refused(ask, headers):
    for path in ("/", "/outcome", "/player", "/scene.toml", "/page.js"):
        status, text, _ = ask(path, **headers)
        assert status == 403
        assert "its own address" in text


def test_own_host_names_are_accepted(ask, server):
    port = server.server_port
    assert server.server_address[0] == "127.0.0.1"
    assert ask("/page.js", Host=f"localhost:{port}")[0] == 200
    assert (
        ask("/page.js", Origin=f"http://127.0.0.1:{port}", Sec_Fetch_Site="same-origin")[0] == 200
    )
    assert ask("/page.js", Host="127.0.0.1:1")[0] == 403
    assert ask("/", method="POST")[0] == 501


@pytest.mark.parametrize("path", [
    "/../../etc/passwd", "/page.py", "/server.py", "//etc/passwd", "/%2e%2e/page.js", "/page.js/",
    "/scene.toml/x", "/player.html", "/.",
])  # fmt: skip
def test_unknown_paths_return_404(ask, path):
    assert ask(path)[0] == 404


@pytest.mark.parametrize(("query", "words"), [
    ("width=abc", "Width: found &#x27;abc&#x27;; expected a number from 0.1 to 5 m"),
    ("width=", "Width: found &#x27;&#x27;"),
    ("height=-3", "Height: found &#x27;-3&#x27;; expected a number from 0.2 to 20 m"),
    ("mass=nan", "Mass: found &#x27;nan&#x27;"),
    ("mass=inf", "Mass: found &#x27;inf&#x27;"),
    ("scale=1e9", "Scale of the motion: found"),
    ("hieght=2", "was &#x27;height&#x27; meant?"),
    ("base=pad", "was &#x27;pads&#x27; meant?"),
    ("motion=sine", "expected one of record, sine_pulse"),
    ("width=<script>", "&lt;script&gt;"),
    ("base=soil&width=5&height=20&soil_stiffness=0.1&mass=200", "soft"),
])  # fmt: skip
def test_invalid_values_are_reported_on_the_page(ask, query, words):
    for path in ("/", "/outcome"):
        status, text, _ = ask(f"{path}?{query.replace('<', '%3C').replace('>', '%3E')}")
        assert status == 200
        assert words in text
        assert "Traceback" not in text
        assert "<script>" not in text


def test_internal_error_is_reported_without_a_traceback(ask, server, monkeypatch, capsys):
    def fails(choice, toml):
        raise ZeroDivisionError

    monkeypatch.setattr(server, "_simulate", fails)
    text = ask("/outcome?width=1.01")[1]
    assert "please report it" in text
    assert "Zero" not in text
    assert "ZeroDivisionError" in capsys.readouterr().err  # for debugging
    assert ask("/?" + "&".join(f"a{k}=1" for k in range(60)))[0] == 400


def test_control_defaults_lie_within_their_ranges():
    choice, faults = read_choice({}, None)
    assert faults == []
    for control in CONTROLS:
        assert control.low <= choice.numbers[control.name] == control.default <= control.high
    assert set(motion_choices(None)) == {*PULSES, "example"}


def test_unavailable_port_raises(server):
    for port in (server.server_port, 99999):
        with pytest.raises(ComponentError, match=f"port {port} cannot be opened"):
            Server(port)


def test_browser_renders_the_page(server, tmp_path):
    browser = which("chromium") or which("google-chrome")
    if browser is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    done = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
         f"--user-data-dir={tmp_path}/profile", "--virtual-time-budget=3000",
         f"{server.address}?base=pads&pad_stiffness=20"],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    assert "Did not overturn: peak rotation" in done.stdout
    assert 'stiffness = "20 MN/m"' in done.stdout
    assert 'data-of="soil" hidden' in done.stdout


def test_clients_that_leave_are_not_reported(server, ask, capsys):
    head = f"GET / HTTP/1.0\r\nHost: 127.0.0.1:{server.server_port}\r\n\r\n".encode()
    with server._lock:  # so that the answers are late
        for sent in (head, head[:9]):
            client = socket.create_connection(("127.0.0.1", server.server_port))
            client.sendall(sent)
            sleep(0.05)
            client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            client.close()  # with a reset
    assert ask("/")[0] == 200
    sleep(0.2)
    assert capsys.readouterr().err == ""


def test_address_that_cannot_be_read_is_answered(ask, capsys):
    status, text, _ = ask("http://[")
    assert (status, text) == (400, "This is no address of a page: Invalid IPv6 URL\n")
    assert capsys.readouterr().err == ""
