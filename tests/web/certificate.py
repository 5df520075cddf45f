"""A certificate for a gateway on loopback."""

import os
import subprocess


def make_certificate(folder):
    """Makes a certificate in `folder` with openssl. Returns the paths of the certificate and of its key."""
    certificate, key = os.path.join(folder, "web.pem"), os.path.join(folder, "web.key")
    subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=bench",
                    "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", certificate], check=True, stderr=subprocess.DEVNULL)
    return certificate, key
