"""Debian's Prometheus scrapes a real daemon, and its alert reaches a receiver through Alertmanager."""
import http.server
import json
import pathlib
import queue
import re
import socket
import subprocess
import sys
import tempfile
import threading
import unittest
import urllib.parse
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/web"))
from real_daemon import BOAT, Daemon, until  # noqa: E402

RULES = ROOT / "deploy/prometheus/telltale.rules.yml"
DASHBOARD = ROOT / "deploy/grafana/telltale.json"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Receiver(http.server.BaseHTTPRequestHandler):
    alerts = queue.Queue()

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        for alert in json.loads(body)["alerts"]:
            self.alerts.put(alert)
        self.send_response(200)
        self.end_headers()

    def log_message(self, *_):
        pass


class ScrapeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = pathlib.Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.daemon = cls.enterClassContext(Daemon(more=2))
        cls.daemon.replay()
        _, headers, _ = cls.daemon.order("refresh")
        until(lambda: cls.daemon.get(headers["Location"])["state"] == "PUBLISHED", "a model", 300)
        receiver = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Receiver)
        threading.Thread(target=receiver.serve_forever, daemon=True).start()
        cls.addClassCleanup(receiver.shutdown)
        (folder / "alertmanager.yml").write_text(
            "route: {receiver: tests, group_wait: 0s, group_by: [alertname]}\n"
            f"receivers: [{{name: tests, webhook_configs: [{{url: 'http://127.0.0.1:{receiver.server_port}/'}}]}}]\n")
        # The rules as they are, but for how long a condition has to last.
        (folder / "telltale.rules.yml").write_text(re.sub(r"for: \d+m", "for: 0s", RULES.read_text()))
        alerts, cls.port = free_port(), free_port()
        example = (ROOT / "deploy/prometheus/prometheus.yml").read_text()
        (folder / "prometheus.yml").write_text(
            example.replace("127.0.0.1:8480", f"127.0.0.1:{cls.daemon.port}").replace(": 5s", ": 1s")
            + f"alerting: {{alertmanagers: [{{static_configs: [{{targets: ['127.0.0.1:{alerts}']}}]}}]}}\n")
        for command in (
                ["prometheus-alertmanager", f"--config.file={folder}/alertmanager.yml", f"--storage.path={folder}/alerts",
                 f"--web.listen-address=127.0.0.1:{alerts}", "--cluster.listen-address="],
                ["prometheus", f"--config.file={folder}/prometheus.yml", f"--storage.tsdb.path={folder}/data",
                 f"--web.listen-address=127.0.0.1:{cls.port}"]):
            log = cls.enterClassContext(open(folder / f"{command[0]}.log", "w"))
            program = subprocess.Popen(command, stdout=log, stderr=log)
            cls.addClassCleanup(program.wait)
            cls.addClassCleanup(program.terminate)
        until(lambda: cls.query("up == 1"), "Prometheus scrapes the daemon", 120)

    @classmethod
    def query(cls, expression):
        """The label sets and values that the expression answers."""
        url = f"http://127.0.0.1:{cls.port}/api/v1/query?" + urllib.parse.urlencode({"query": expression})
        with urllib.request.urlopen(url, timeout=10) as answer:
            return [(one["metric"], float(one["value"][1])) for one in json.load(answer)["data"]["result"]]

    def test_the_text_passes_promtool(self):
        _, headers, text = self.daemon.ask("GET", "/metrics")
        self.assertTrue(headers["Content-Type"].startswith("text/plain; version=0.0.4"))
        checked = subprocess.run(["promtool", "check", "metrics"], input=text, text=True, capture_output=True)
        self.assertEqual((checked.returncode, checked.stderr), (0, ""), checked.stdout)

    def test_the_scrape_tells_what_the_api_tells(self):
        quality = self.daemon.get(f"/api/v1/vehicles/{BOAT}")
        self.assertEqual([value for _, value in self.query("telltale_vehicles")], [3])
        def revision():
            return [value for _, value in self.query(f'telltale_vehicle_model_revision{{vehicle_id="{BOAT}"}}')]
        until(lambda: revision() == [1], "the revision")
        accepted = self.query(f'telltale_vehicle_samples_accepted_total{{vehicle_id="{BOAT}"}}')
        self.assertEqual([value for _, value in accepted], [quality["accepted"]])
        verdicts = self.query('telltale_vehicle_verdict{vehicle_id="boat-0000"} == 1')
        self.assertEqual([labels["verdict"] for labels, _ in verdicts], ["STALE"])
        published = self.query('telltale_jobs_total{kind="refresh",outcome="published"}')
        self.assertEqual([value for _, value in published], [1])

    def test_the_daemon_tells_what_its_parts_are_at(self):
        def value(expression):
            found = self.query(expression)
            return found[0][1] if found else None
        until(lambda: value('telltale_store_write_seconds_count{store="models"}') == 1, "the model is written")
        self.assertGreater(value('telltale_store_write_seconds_sum{store="models"}'), 0)
        quality = self.daemon.get(f"/api/v1/vehicles/{BOAT}")
        received = quality["accepted"] + sum(entry["count"] for entry in quality["rejected"])
        until(lambda: value("sum(telltale_received_samples_total)") == received, "the samples of the replay")
        for queue in ("identification", "diagnosis"):
            for name, wanted in (("requests_waiting", 0), ("requests_running", 0), ("requests_shed_total", 0)):
                until(lambda: value(f'telltale_queue_{name}{{queue="{queue}"}}') == wanted, f"{name} of {queue}")
            self.assertGreater(value(f'telltale_queue_workers{{queue="{queue}"}}'), 0)
        with self.daemon.replaying("boat-0001"):
            until(lambda: value('telltale_dds_matches{topic="telltale/telemetry/gnss"}') == 1, "a boat is connected")
        until(lambda: value('telltale_dds_matches{topic="telltale/telemetry/gnss"}') == 0, "it has gone")

    def test_rules_and_dashboard_name_metrics_that_are_there(self):
        page = (ROOT / "docs/reference/metrics.md").read_text()
        _, _, text = self.daemon.ask("GET", "/metrics")
        scraped = set(re.findall(r"^# TYPE (\S+)", text, re.M))
        documented = set(re.findall(r"`((?:telltale|process)_\w+)", page))
        # Those that come only with a fault of the telemetry, with a minute of it, with a model of the physical form, or
        # with workers.
        sometimes = {"telltale_vehicle_samples_rejected_total", "telltale_unattributed_samples_total",
                     "telltale_vehicle_prediction_error_ratio", "telltale_vehicle_delay_seconds",
                     "telltale_worker_jobs", "telltale_worker_jobs_total"}
        self.assertEqual(documented - sometimes, scraped - sometimes)
        self.assertLessEqual(sometimes, documented)
        for file in (RULES, DASHBOARD):
            named = set(re.findall(r"(?:telltale_(?:vehicle|jobs|queue|store|window|dds)|process)_\w+", file.read_text()))
            named = {re.sub("_(?:sum|count)$", "", name) for name in named}  # of a summary
            self.assertTrue(named)
            self.assertLessEqual(named, documented, file)

    def test_every_panel_has_an_expression_that_prometheus_takes(self):
        for panel in json.loads(DASHBOARD.read_text())["panels"]:
            for target in panel["targets"]:
                self.query(target["expr"].replace("$boat", ".*"))  # raises where it does not parse

    def test_an_alert_reaches_its_receiver(self):
        while True:
            alert = Receiver.alerts.get(timeout=120)
            if alert["labels"]["alertname"] == "TelltaleNoTelemetry" and alert["labels"]["vehicle_id"] == "boat-0000":
                break
        self.assertEqual(alert["annotations"]["summary"], "boat-0000: no telemetry arrives")


if __name__ == "__main__":
    unittest.main()
