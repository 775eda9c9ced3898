"""The HTTP API of a real daemon against docs/reference/openapi.json, and against bad clients."""
import concurrent.futures
import gzip
import html
import http.client
import json
import pathlib
import random
import re
import socket
import ssl
import subprocess
import tempfile
import unittest

from real_daemon import BOAT, ROOT, TOKEN, Daemon, until

API = json.loads((ROOT / "docs/reference/openapi.json").read_text())
TYPES = {"string": str, "number": (int, float), "integer": int, "boolean": bool, "array": list,
         "object": dict}


def faults(value, schema, where="$"):
    """What of the schema the value does not keep to; by the part of JSON Schema that the file uses."""
    if "$ref" in schema:
        return faults(value, API["components"]["schemas"][schema["$ref"].split("/")[-1]], where)
    kinds = schema.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    fits = [k for k in kinds if isinstance(value, TYPES[k])
            and (k == "boolean" or not isinstance(value, bool))]
    if kinds and not fits:
        return [f"{where} is {value!r}, no {kinds}"]
    found = []
    if "enum" in schema and value not in schema["enum"]:
        found.append(f"{where} is {value!r}, not of {schema['enum']}")
    if isinstance(value, dict):
        known = schema.get("properties", {})
        found += [f"{where} lacks {name}" for name in schema.get("required", []) if name not in value]
        if schema.get("additionalProperties") is False:
            found += [f"{where}.{name} is unknown" for name in value if name not in known]
        for name, item in value.items():
            found += faults(item, known.get(name, {}), f"{where}.{name}")
    if isinstance(value, list):
        for index, item in enumerate(value):
            found += faults(item, schema.get("items", {}), f"{where}[{index}]")
    return found


class TestSchemaCheck(unittest.TestCase):
    def test_finds_faults(self):
        failure = {"$ref": "#/components/schemas/Failure"}
        self.assertEqual(faults({"error": "a", "allowed": ""}, failure), [])
        self.assertEqual(faults({"error": 1}, failure), ["$ lacks allowed", "$.error is 1, no ['string']"])
        self.assertEqual(faults({"error": "", "allowed": "", "x": 1}, failure), ["$.x is unknown"])
        self.assertTrue(faults("BAD", {"$ref": "#/components/schemas/Verdict"}))


class ApiTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.daemon = Daemon(more=30)
        cls.addClassCleanup(cls.daemon.__exit__)
        cls.daemon.replay(last_s=400)
        for kind in ("refresh", "refresh", "diagnose"):
            if kind == "diagnose":  # on what did not make the model
                cls.daemon.replay(first_s=400.01)
            status, headers, job = cls.daemon.order(kind)
            assert status == 202, job
            route = headers["Location"]
            cls.job = until(lambda route=route: (job := cls.daemon.get(route))["state"] != "RUNNING" and job,
                            f"{kind} ends", 300)
            assert cls.job["state"] == "PUBLISHED", cls.job
        until(lambda: cls.daemon.ask("GET", f"/api/v1/vehicles/{BOAT}/diagnosis")[0] == 200, "a diagnosis")
        until(lambda: cls.daemon.get(f"/api/v1/vehicles/{BOAT}").get("model", {}).get("revision") == 2, "revision 2")

    def keeps_to_schema(self, method, template, status, headers, text):
        operation = API["paths"][template][method.lower()]
        self.assertIn(str(status), operation["responses"], f"{method} {template}: {status} {text}")
        content = operation["responses"][str(status)].get("content", {})
        if "application/json" not in content:
            return
        self.assertEqual(headers["Content-Type"], "application/json")
        self.assertEqual(faults(json.loads(text), content["application/json"]["schema"]), [], template)

    def test_every_route_answers_as_the_file_says(self):
        kept = self.daemon.get(f"/api/v1/vehicles/{BOAT}/diagnoses")["diagnoses"]
        filled = {"{revision}": "1", "{published}": str(kept[0]["publishedUnixS"])}
        for template, operations in API["paths"].items():
            if "get" not in operations or template.endswith(("/events", "/metrics")):
                continue
            with self.subTest(template):
                route = template.replace("{id}", self.job["id"] if "/jobs/" in template else BOAT)
                for name, value in filled.items():
                    route = route.replace(name, value)
                status, headers, text = self.daemon.ask("GET", route)
                self.assertEqual(status, 200, text)
                self.keeps_to_schema("GET", template, status, headers, text)
                if "{id}" in template:
                    wrong = route.replace(BOAT, "nobody").replace(self.job["id"], "nobody")
                    status, headers, text = self.daemon.ask("GET", wrong)
                    self.assertEqual(status, 404)
                    self.keeps_to_schema("GET", template, status, headers, text)
                for parameter in operations["get"]["parameters"]:
                    if parameter["schema"].get("type") != "integer" or parameter["in"] != "query":
                        continue
                    for bad in ("0", "-1", "x", "", "99999999999999999999"):
                        status, headers, text = self.daemon.ask("GET", f"{route}?{parameter['name']}={bad}")
                        self.assertEqual(status, 400, f"{parameter['name']}={bad}")
                        self.keeps_to_schema("GET", template, status, headers, text)
                        self.assertIn(parameter["name"], json.loads(text)["error"])

    def test_the_file_is_served(self):
        status, _, text = self.daemon.ask("GET", "/api/v1/openapi.json")
        if status == 404 and self.daemon.ask("GET", "/")[0] == 404:
            self.skipTest("built without the page")
        self.assertEqual(json.loads(text), API)

    def test_etag_spares_what_is_known(self):
        route = f"/api/v1/vehicles/{BOAT}/models"
        status, headers, _ = self.daemon.ask("GET", route)
        again, _, text = self.daemon.ask("GET", route, headers={"If-None-Match": headers["ETag"]})
        self.assertEqual((status, again, text), (200, 304, ""))
        other, _, _ = self.daemon.ask("GET", route, headers={"If-None-Match": '"another"'})
        self.assertEqual(other, 200)

    def test_answers_are_compressed_by_gzip_alone(self):
        # Brotli takes seconds for a large answer.
        for takes, gets in (("gzip, deflate, br, zstd", "gzip"), ("br", None), ("identity", None)):
            client = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=60)
            client.request("GET", "/api/v1/vehicles", headers={"Accept-Encoding": takes})
            answer = client.getresponse()
            text = answer.read()
            self.assertEqual(answer.headers["Content-Encoding"], gets, takes)
            self.assertEqual(json.loads(gzip.decompress(text) if gets else text)["total"], 31)
            client.close()

    def test_pages_hold_every_boat_once(self):
        seen, after = [], ""
        while True:
            page = self.daemon.get(f"/api/v1/vehicles?limit=7&after={after}")
            self.assertEqual(page["total"], 31)
            seen += [vehicle["vehicleId"] for vehicle in page["vehicles"]]
            after = page["next"]
            if not after:
                break
            self.assertEqual(len(page["vehicles"]), 7)
        self.assertEqual(seen, sorted(f"boat-{n:04}" for n in range(30)) + [BOAT])

    def test_filters(self):
        page = self.daemon.get("/api/v1/vehicles?match=boat-000&verdict=STALE,OK")
        self.assertEqual(page["total"], 10)
        self.assertEqual(self.daemon.get("/api/v1/vehicles?match=boat-&verdict=OK")["total"], 0)
        status, _, text = self.daemon.ask("GET", "/api/v1/vehicles?verdict=BAD")
        self.assertEqual((status, json.loads(text)["allowed"]), (400, "OK, WARN, ERROR or STALE"))

    def test_models_page_by_revision(self):
        route = f"/api/v1/vehicles/{BOAT}/models?limit=1"
        first = self.daemon.get(route)
        newest = int(first["models"][0]["provenance"]["revision"])
        self.assertGreaterEqual(newest, 2)
        self.assertEqual(first["next"], newest)
        second = self.daemon.get(f"{route}&before={newest}")
        self.assertEqual([m["provenance"]["revision"] for m in second["models"]], [str(newest - 1)])
        last = self.daemon.get(f"{route}&before=2")
        self.assertEqual([m["provenance"]["revision"] for m in last["models"]], ["1"])
        self.assertEqual(last["next"], 0)

    def test_orders_need_the_token(self):
        for kind in ("refresh", "diagnose", "rollback"):
            for status, arguments in ((401, {"token": None}), (401, {"token": TOKEN + "x"}),
                                      (401, {"token": TOKEN[:-1]}), (404, {"boat": "nobody"}),
                                      (400, {"body": "{"}), (400, {"body": '{"boat": "x"}'}),
                                      (415, {"content": "text/plain"})):
                answered, headers, answer = self.daemon.order(kind, **arguments)
                self.assertEqual(answered, status, (kind, arguments, answer))
                self.keeps_to_schema("POST", f"/api/v1/{kind}", answered, headers, json.dumps(answer))

    def test_an_earlier_model_is_published_again(self):
        route = f"/api/v1/vehicles/{BOAT}/models"
        first = self.daemon.get(f"{route}/1")
        status, headers, answer = self.daemon.order("rollback", revision=1)
        self.assertEqual(status, 200, answer)
        self.keeps_to_schema("POST", "/api/v1/rollback", status, headers, json.dumps(answer))
        revision = int(answer["provenance"]["revision"])
        self.assertEqual(headers["Location"], f"{route}/{revision}")
        again = self.daemon.get(headers["Location"])
        self.assertEqual(again["coefficients"], first["coefficients"])
        self.assertEqual(self.daemon.get(route)["models"][0]["provenance"]["revision"], str(revision))
        history = self.daemon.telltale("history", "--vehicle-id", BOAT)
        self.assertIn("revision 1 published again", history)
        for status, more in ((404, {"revision": 999}), (404, {}), (400, {"revision": -1}), (400, {"revision": "x"}),
                             (400, {"revision": 1.5})):
            answered, headers, answer = self.daemon.order("rollback", **more)
            self.assertEqual(answered, status, (more, answer))
            self.keeps_to_schema("POST", "/api/v1/rollback", answered, headers, json.dumps(answer))

    def refused(self, route, status, template):
        """What the answer says would do."""
        answered, headers, text = self.daemon.ask("GET", route)
        self.assertEqual(answered, status, (route, text))
        self.keeps_to_schema("GET", template, answered, headers, text)
        return json.loads(text)["allowed"]

    def test_two_revisions_are_compared(self):
        template = "/api/v1/vehicles/{id}/comparison"
        route = template.replace("{id}", BOAT)
        answer = self.daemon.get(f"{route}?earlier=1&later=2")
        self.assertEqual((answer["earlier"], answer["later"], answer["change"]["revision"]), (1, 2, "1"))
        files = []
        for revision in (1, 2):
            files.append(self.daemon.folder / f"r{revision}.json")
            files[-1].write_text(json.dumps(self.daemon.get(f"/api/v1/vehicles/{BOAT}/models/{revision}")))
        told = self.daemon.compare(*files)
        self.assertEqual(answer["sentence"].split(" Revision")[0], told.splitlines()[0])
        newest = self.daemon.get(f"/api/v1/vehicles/{BOAT}/models?limit=1")["models"][0]["provenance"]["revision"]
        self.assertEqual(self.daemon.get(route)["later"], int(newest))
        for query, status in (("earlier=2&later=2", 400), ("earlier=2&later=1", 400), ("later=999", 404),
                              ("later=1", 404)):
            self.refused(f"{route}?{query}", status, template)
        self.refused("/api/v1/vehicles/boat-0000/comparison", 404, template)

    def test_a_model_is_exported(self):
        template = "/api/v1/vehicles/{id}/models/{revision}/export"
        route = f"/api/v1/vehicles/{BOAT}/models/1/export"
        model = self.daemon.folder / "exported.json"
        model.write_text(json.dumps(self.daemon.get(f"/api/v1/vehicles/{BOAT}/models/1")))
        status, headers, text = self.daemon.ask("GET", f"{route}?format=mss")
        self.assertEqual((status, headers["Content-Disposition"]), (200, f'attachment; filename="{BOAT}-r1.mss.json"'))
        self.assertEqual(text, self.daemon.exported(model, "mss"))
        # The vehicle file of the sample states no mass, which drags in newtons need.
        self.assertIn("mass", self.refused(f"{route}?format=vrx", 404, template))
        self.assertIn("mss or vrx", self.refused(f"{route}?format=x", 400, template))
        self.refused(f"/api/v1/vehicles/{BOAT}/models/999/export", 404, template)

    def test_the_report_of_a_diagnosis_is_a_page(self):
        route = f"/api/v1/vehicles/{BOAT}/diagnosis"
        status, headers, text = self.daemon.ask("GET", f"{route}/report")
        self.assertEqual((status, headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        self.assertEqual(headers.get_all("Content-Security-Policy")[0].count("unsafe-inline"), 1)
        self.assertEqual(len(headers.get_all("Content-Security-Policy")), 1)
        self.assertIn(self.daemon.get(route)["sentence"], html.unescape(text))

    def test_each_diagnosis_is_kept(self):
        route = f"/api/v1/vehicles/{BOAT}/diagnoses"
        _, headers, _ = self.daemon.order("diagnose")
        until(lambda: self.daemon.get(headers["Location"])["state"] == "PUBLISHED", "another diagnosis")
        last, first = self.daemon.get(route)["diagnoses"]
        self.assertGreater(last["publishedUnixS"], first["publishedUnixS"])
        newest = until(lambda: (told := self.daemon.get(f"/api/v1/vehicles/{BOAT}/diagnosis"))["publishedUnixS"]
                       == last["publishedUnixS"] and told, "the newest is the last")
        self.assertEqual(self.daemon.get(f"{route}/{last['publishedUnixS']}"), newest)
        earlier = self.daemon.get(f"{route}/{first['publishedUnixS']}")
        self.assertEqual({name: earlier[name] for name in ("publishedUnixS", "verdict", "sentence")},
                         {name: first[name] for name in ("publishedUnixS", "verdict", "sentence")})
        _, _, page = self.daemon.ask("GET", f"{route}/{first['publishedUnixS']}/report")
        self.assertIn(first["sentence"], html.unescape(page))
        for wrong in ("1", "x", "nan"):
            self.assertIn("diagnoses", self.refused(f"{route}/{wrong}", 404, "/api/v1/vehicles/{id}/diagnoses/{published}"))
        self.assertEqual(self.daemon.get("/api/v1/vehicles/boat-0000/diagnoses"), {"diagnoses": []})

    def test_paths_are_predicted(self):
        template = "/api/v1/vehicles/{id}/predicted-paths"
        route = template.replace("{id}", BOAT)
        answer = self.daemon.get(f"{route}?seconds=120&horizon=30")
        self.assertEqual(len(answer["predicted"]), 4)
        for path in (answer["measured"], *answer["predicted"]):
            self.assertEqual(len(path["timeS"]), len(path["northM"]))
            self.assertEqual(len(path["timeS"]), len(path["eastM"]))
        self.assertLess(answer["positionRmseM"], 10)  # metres, of a model that fits
        self.assertIn("[5, 60]", self.refused(f"{route}?seconds=60&horizon=61", 400, template))
        self.assertIn("[10, 600]", self.refused(f"{route}?seconds=601", 400, template))
        self.assertIn("telltale identify", self.refused("/api/v1/vehicles/boat-0000/predicted-paths", 404, template))

    def test_many_who_ask_for_paths_do_not_stop_others(self):
        template = "/api/v1/vehicles/{id}/predicted-paths"
        route = template.replace("{id}", BOAT)
        questions = [f"{route}?seconds={600 - n}&horizon={5 + n}" for n in range(60)]
        with concurrent.futures.ThreadPoolExecutor(20) as clients:
            answers = [clients.submit(self.daemon.ask, "GET", question) for question in questions]
            self.assertEqual(self.daemon.get("/api/v1")["vehicles"], 31)
            for answer in answers:
                status, headers, text = answer.result()
                self.assertIn(status, (200, 503), text)
                self.keeps_to_schema("GET", template, status, headers, text)
                self.assertEqual("Retry-After" in headers, status == 503)

    def test_a_large_body_is_refused(self):
        status, _, _ = self.daemon.ask("POST", "/api/v1/refresh", "x" * 100_000,
                                       {"Content-Type": "application/json", "Authorization": f"Bearer {TOKEN}"})
        self.assertEqual(status, 413)

    def test_unknown_routes_and_methods(self):
        for method, route in (("GET", "/nothing"), ("GET", "/api/v1/vehicles/a/b/c/d"), ("DELETE", "/api/v1/vehicles"),
                              ("GET", "/../etc/passwd"), ("GET", "/api/v1/vehicles/%00")):
            status, _, text = self.daemon.ask(method, route)
            self.assertEqual(status, 404, route)
            self.assertEqual(faults(json.loads(text), {"$ref": "#/components/schemas/Failure"}), [])

    def test_events_follow_the_fleet_and_the_jobs(self):
        with EventReader(self.daemon) as events:
            fleet = events.await_event("fleet")
            self.assertEqual(faults(fleet, {"$ref": "#/components/schemas/VehicleList"}), [])
            self.assertEqual(fleet["total"], 31)
            _, _, job = self.daemon.order("refresh")
            states = []
            while not states or states[-1] == "RUNNING":
                event = events.await_event("job")
                self.assertEqual(faults(event, {"$ref": "#/components/schemas/Job"}), [])
                if event["id"] == job["id"]:
                    states.append(event["state"])
            self.assertEqual(states[-1], "PUBLISHED")

    def test_streams_leave_connections_for_others(self):
        readers = [EventReader(self.daemon) for _ in range(24)]  # three quarters of 32
        try:
            for reader in readers:
                reader.await_event("fleet")
            status, headers, text = self.daemon.ask("GET", "/api/v1/events")
            self.assertEqual(status, 503, text)
            self.assertTrue(headers["Retry-After"])
            self.assertEqual(self.daemon.get("/api/v1")["vehicles"], 31)
        finally:
            for reader in readers:
                reader.__exit__()
        until(lambda: gauge(self.daemon, "telltale_event_streams") == 0, "the streams end")

    def test_slow_and_silent_clients_do_not_stop_others(self):
        idle = []
        for number in range(20):
            client = socket.create_connection(("127.0.0.1", self.daemon.port))
            client.sendall(b"GET / HTTP/1.1\r\nX-Slow: "[: number + 1])
            idle.append(client)
        self.assertEqual(self.daemon.get("/api/v1")["vehicles"], 31)
        for client in idle:
            client.close()

    def test_more_clients_than_connections_are_served_in_turn(self):
        clients = [http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=60) for _ in range(30)]
        for client in clients:
            client.request("GET", "/api/v1", headers={"Connection": "close"})
        for client in clients:
            self.assertEqual(client.getresponse().status, 200)
            client.close()

    def test_garbage_is_answered_or_closed(self):
        draw = random.Random(7)
        parts = [b"GET ", b"POST ", b"/api/v1/refresh", b"/api/v1/vehicles?limit=", b" HTTP/1.1\r\n", b"\r\n", b"\r\n\r\n",
                 b"Content-Length: 18446744073709551615\r\n", b"Transfer-Encoding: chunked\r\n", b"ffffffff\r\n",
                 b"Host: x\r\n", b"%", b"\x00\xff\xfe", b"A" * 9000, b"Range: bytes=0-1,5-,-\r\n", b'{"vehicleId":']
        for _ in range(200):
            message = b"".join(draw.choice(parts) for _ in range(draw.randint(1, 9)))
            with socket.create_connection(("127.0.0.1", self.daemon.port), timeout=30) as client:
                client.sendall(message)
                client.shutdown(socket.SHUT_WR)
                try:
                    answer = client.recv(65536)
                except ConnectionResetError:
                    continue
                self.assertTrue(answer == b"" or re.match(rb"HTTP/1.1 [2-5]\d\d ", answer), answer[:80])
        self.assertEqual(self.daemon.get("/api/v1")["vehicles"], 31)


class ModelQualityTest(unittest.TestCase):
    def test_the_quality_tells_what_the_model_tells(self):
        with Daemon() as daemon:
            daemon.replay()
            daemon.telltale("identify", "--vehicle-id", BOAT, "--structure", "fossen")
            route = f"/api/v1/vehicles/{BOAT}"
            told = until(lambda: daemon.get(route).get("model"), "a quality with the model")
            model = daemon.get(f"{route}/models/1")
            self.assertEqual(told["verdict"], model["provenance"]["verdict"])
            for channel, delay in (("gnss", model["delays"]["fixes"]), ("thrusters", model["delays"]["commands"])):
                published = {"channel": channel, "estimateS": delay["estimate"],
                             "lowerS": delay["interval"]["lower"], "upperS": delay["interval"]["upper"]}
                self.assertIn(published, told["delays"])
            self.assertIn(f'telltale_vehicle_delay_seconds{{vehicle_id="{BOAT}",channel="gnss"}}',
                          daemon.ask("GET", "/metrics")[2])
            self.assertIn(f'telltale_vehicle_model_verdict{{vehicle_id="{BOAT}",verdict="{told["verdict"]}"}} 1',
                          daemon.ask("GET", "/metrics")[2])


class RateTest(unittest.TestCase):
    def test_a_client_that_asks_too_often_is_told_when_to_come_back(self):
        with Daemon(http="requests_per_minute: 60") as daemon:
            def refused():
                status, headers, text = daemon.ask("GET", "/api/v1")
                return status == 429 and (headers, json.loads(text))
            headers, failure = until(refused, "more than 60 requests in a minute")
            self.assertTrue(1 <= int(headers["Retry-After"]) <= 60)
            self.assertEqual(failure["allowed"], "60 a minute; see http.requests_per_minute")
            self.assertEqual(daemon.order("refresh", "nobody")[0], 404)  # orders count by themselves


class ReadOnlyTest(unittest.TestCase):
    def test_without_a_token_nothing_can_be_changed(self):
        with Daemon(token=False) as daemon:
            self.assertTrue(daemon.get("/api/v1")["readOnly"])
            status, _, answer = daemon.order("refresh")
            self.assertEqual(status, 403)
            self.assertIn("token_file", answer["allowed"])
            self.assertEqual(daemon.get("/api/v1/jobs")["jobs"], [])
            self.assertIn(socket_address(daemon.port), ("0100007F", ))
            with EventReader(daemon) as events:  # an open stream does not hold the daemon up
                events.await_event("fleet")
                daemon.stop()


class SettingsTest(unittest.TestCase):
    """Wrong settings end the daemon with a line that names them."""

    def end_of(self, **settings):
        with self.assertRaises(AssertionError) as ended, Daemon(**settings):
            pass
        return str(ended.exception)

    def test_a_port_that_is_taken(self):
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            self.assertIn(f"cannot listen on 127.0.0.1 port {port}", self.end_of(port=port))

    def test_a_token_that_is_short_or_not_there(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "short").write_text(" 123456789012345\n")
            for name, said in (("short", "a token of 15 characters"), ("absent", "http.token_file")):
                self.assertIn(said, self.end_of(token=False, http=f'token_file: "{folder}/{name}"'))

    def test_a_key_that_is_none(self):
        self.assertIn("no PEM pair", self.end_of(http='tls_chain_file: "token" tls_key_file: "token"'))


class TlsTest(unittest.TestCase):
    def test_speaks_tls_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            chain, key = f"{folder}/chain.pem", f"{folder}/key.pem"
            subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
                            "-nodes", "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1",
                            "-keyout", key, "-out", chain], check=True, capture_output=True)
            with Daemon(http=f'tls_chain_file: "{chain}" tls_key_file: "{key}"') as daemon:
                self.assertTrue(daemon.address.startswith("https://"))
                trusted = ssl.create_default_context(cafile=chain)
                client = http.client.HTTPSConnection("127.0.0.1", daemon.port, context=trusted, timeout=30)
                client.request("GET", "/api/v1")
                self.assertEqual(client.getresponse().status, 200)
                client.close()
                with self.assertRaises((http.client.HTTPException, OSError)):
                    daemon.ask("GET", "/api/v1")


def socket_address(port):
    """The address, in hexadecimal, on which this machine listens at the port."""
    for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]:
        address, state = line.split()[1], line.split()[3]
        if state == "0A" and int(address.split(":")[1], 16) == port:
            return address.split(":")[0]
    return None


def gauge(daemon, name):
    _, _, text = daemon.ask("GET", "/metrics")
    return float(re.search(rf"^{name} (\S+)$", text, re.M).group(1))


class EventReader:
    def __init__(self, daemon):
        self.connection = http.client.HTTPConnection("127.0.0.1", daemon.port, timeout=60)
        self.connection.request("GET", "/api/v1/events")
        self.answer = self.connection.getresponse()
        assert self.answer.status == 200, self.answer.status
        assert self.answer.headers["Content-Type"] == "text/event-stream"

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.connection.close()

    def await_event(self, name):
        event = None
        while True:
            line = self.answer.readline().decode()
            assert line, "the stream ended"
            if line.startswith("event: "):
                event = line[7:].strip()
            if line.startswith("data: ") and event == name:
                return json.loads(line[6:])


if __name__ == "__main__":
    unittest.main()
