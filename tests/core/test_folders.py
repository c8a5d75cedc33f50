from core.folders import cache_dir, data_dir


def test_the_environment_decides_first(monkeypatch, tmp_path):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    assert data_dir() == tmp_path / "data"
    assert cache_dir() == tmp_path / "cache"


def test_without_it_the_folders_are_the_users_own_and_differ(monkeypatch):
    monkeypatch.delenv("EFASE_DATA_DIR", raising=False)
    monkeypatch.delenv("EFASE_CACHE_DIR", raising=False)
    assert data_dir().is_absolute()
    assert cache_dir().is_absolute()
    assert data_dir() != cache_dir()
    assert "efase" in str(data_dir()).lower()
