#include "pincer/tasks/lab/experiments/study_writer.h"

namespace pincer::tasks {

void CommentedJson::value(std::string_view json, std::string_view comment) {
  endLine(true);
  text_ += indent_ + key_ + std::string(json);
  if (explains) comment_ = comment;
  key_.clear();
  pending_ = true;
}

void CommentedJson::key(std::string_view name) { key_ = quotedJson(name) + ": "; }

void CommentedJson::open(char bracket) {
  endLine(true);
  text_ += indent_ + key_ + bracket + '\n';
  key_.clear();
  indent_ += "  ";
}

void CommentedJson::close(char bracket) {
  endLine(false);
  indent_.resize(indent_.size() - 2);
  text_ += indent_ + bracket;
  pending_ = true;
}

const std::string& CommentedJson::text() {
  endLine(false);
  return text_;
}

void CommentedJson::endLine(bool comma) {
  if (!pending_) return;
  text_ += comma ? "," : "";
  if (!comment_.empty()) text_ += "  // " + comment_;
  text_ += "\n";
  comment_.clear();
  pending_ = false;
}

}  // namespace pincer::tasks
